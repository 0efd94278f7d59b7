#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/entries/entries.hpp"
#include "convex/composite/atom.hpp"

using convex::Call;
using convex::Function;
using convex::Index;
using convex::Metric;
using convex::Prox;
using convex::Space;
using convex::Vector;

namespace {

struct Example {
  std::string text;
  Index n;
  Function f;
};

std::vector<Example> examples() {
  std::vector<Example> made;
  std::vector<convex::CatalogueEntry> entries = convex::set_entries();
  for (const convex::CatalogueEntry& entry : convex::function_entries()) entries.push_back(entry);
  for (const convex::CatalogueEntry& entry : entries)
    for (std::string_view text : entry.examples) {
      const Call call = cli::parse_call(text, "example");
      const auto make = [&](Index n) {
        const Function f = convex::make_function(call, Space{Metric::identity(n)});
        made.push_back({std::string(text) + " on " + std::to_string(n), n, f});
        return f.dimension() == 0;
      };
      const bool any_size = make(cli::number_of_entries(call));
      for (Index n : {1, 2, 6, 9}) try {
          if (any_size) make(n);
        } catch (const convex::InvalidInput&) {  // no square, no group, …
        }
    }
  return made;
}

/// Points near the origin, of size one, on small integers (ties, kinks), and far away.
std::vector<Vector> points(Index n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<Vector> points;
  for (double scale : {1e-8, 1e-3, 1.0, 3.0, 1e6})
    for (int repeat = 0; repeat < 3; ++repeat) {
      Vector z(n);
      for (double& entry : z) entry = scale * normal(generator);
      points.push_back(z);
    }
  for (int repeat = 0; repeat < 4; ++repeat) {
    Vector z(n);
    for (double& entry : z) entry = static_cast<double>(generator() % 5) - 2;
    points.push_back(z);
  }
  points.push_back(Vector::Zero(n));
  return points;
}

Vector weights(Index n) {
  Vector d(n);
  for (Index i = 0; i < n; ++i) d[i] = 0.5 + static_cast<double>(i % 3);
  return d;
}

std::vector<Metric> simple_metrics(Index n) {
  return {Metric::identity(n), Metric::identity(n).scaled(0.3), Metric::diagonal(weights(n))};
}

/// Sizes that rounding in a prox is relative to; beside data of size 1 nothing counts below 1e-14.
double size(const Metric& W, const Vector& z, const Vector& x) { return W.norm(z) + W.norm(x) + 1e-14; }

}  // namespace

TEST_CASE("a point is the sum of the prox of a function and of its conjugate in the inverse metric") {
  for (const auto& [text, n, f] : examples()) {
    const Function g = f.conjugate();
    for (const Metric& W : simple_metrics(n)) {
      const Metric inverse = Metric::diagonal(W.diagonal().cwiseInverse());
      for (const Vector& z : points(n, 1)) {
        CAPTURE(text);
        CAPTURE(z.transpose());
        CAPTURE(W.diagonal().transpose());
        const Prox x = f.prox(z, W), y = g.prox(W.multiply(z), inverse);
        REQUIRE(x.status == convex::Status::solved);
        REQUIRE(y.status == convex::Status::solved);
        CHECK(W.norm(z - x.x - W.solve(y.x)) <= 1e-12 * size(W, z, x.x));
        constexpr double data_rounding = 8e-16;  // of the functions' own numbers, which are near 1
        CHECK(x.error_bound <= 1e-12 * size(W, z, x.x) + data_rounding);
        CHECK(y.error_bound <= 1e-12 * size(inverse, W.multiply(z), y.x) + data_rounding);
      }
    }
  }
}

TEST_CASE("Fenchel's inequality is an equation at a prox, by the formulas of both values") {
  for (const auto& [text, n, f] : examples()) {
    const Function g = f.conjugate();
    for (const Vector& z : points(n, 2)) {
      CAPTURE(text);
      CAPTURE(z.transpose());
      const Prox x = f.prox(z, Metric::identity(n));
      const double f_x = f(x.x), g_v = g(x.v);
      CAPTURE(x.x.transpose());
      CAPTURE(x.v.transpose());
      CHECK(std::isfinite(f_x));
      CHECK(std::isfinite(g_v));
      const double terms = std::abs(f_x) + std::abs(g_v) + x.x.cwiseAbs().dot(x.v.cwiseAbs()) +
                           z.squaredNorm() * 1e-3 + 1e-300;
      CHECK(std::abs(f_x + g_v - x.x.dot(x.v)) <= 1e-12 * terms);
    }
  }
}

TEST_CASE("Fenchel's inequality holds at any two points") {
  for (const auto& [text, n, f] : examples()) {
    const Function g = f.conjugate();
    for (const Vector& x : points(n, 3))
      for (const Vector& v : points(n, 4)) {
        const double f_x = f(x), g_v = g(v);
        if (std::isinf(f_x) || std::isinf(g_v)) continue;
        CAPTURE(text);
        CAPTURE(x.transpose());
        CAPTURE(v.transpose());
        CHECK(f_x + g_v - x.dot(v) >= -1e-12 * (std::abs(f_x) + std::abs(g_v) + x.norm() * v.norm()));
      }
  }
}

TEST_CASE("a subgradient is one by the inequality and by the prox") {
  for (const auto& [text, n, f] : examples())
    for (const Vector& z : points(n, 5)) {
      const Vector x = f.prox(z, Metric::identity(n)).x;
      const auto v = f.subgradient(x);
      if (!v) continue;
      CAPTURE(text);
      CAPTURE(x.transpose());
      CAPTURE(v->transpose());
      CHECK(f.is_subgradient(*v, x));
      const double f_x = f(x);
      for (const Vector& u : points(n, 6)) {
        const double f_u = f(u);
        if (std::isinf(f_u)) continue;
        CHECK(f_u - f_x - v->dot(u - x) >=
              -1e-12 * (std::abs(f_u) + std::abs(f_x) + v->norm() * (u.norm() + x.norm())));
      }
    }
}

TEST_CASE("a function and its conjugate are written so that they read back as the same functions") {
  for (const auto& [text, n, f] : examples()) {
    const Function g = f.conjugate();
    for (const Function& written : {f, g, g.conjugate()}) {
      const std::string again = convex::to_text(written.call());
      CAPTURE(text);
      CAPTURE(again);
      const Function read = convex::make_function(cli::parse_call(again, "call"), Space{Metric::identity(n)});
      for (const Vector& x : points(n, 7)) {
        CAPTURE(x.transpose());
        const double first = written(x), second = read(x);
        if (std::isfinite(first))
          CHECK(std::abs(first - second) <= 1e-13 * (std::abs(first) + x.norm()));
        else
          CHECK(first == second);
      }
    }
  }
}

TEST_CASE("the derivative of a prox is that of its differences where it is smooth") {
  for (const auto& [text, n, f] : examples()) {
    const auto* atom = dynamic_cast<const convex::Atom*>(&f.node());
    if (!atom) continue;
    for (const double scale : {1.0, 0.3}) {
      const Vector d = Vector::Constant(n, scale);
      for (const Vector& z : points(n, 8)) {
        if (z.norm() > 100 || z.norm() < 0.1) continue;
        const convex::Matrix J = atom->prox_jacobian(z, d);
        for (Index j = 0; j < n; ++j) {
          const double step = 1e-6;
          const Vector h = step * Vector::Unit(n, j);
          const Vector forward = (atom->prox_diagonal(z + h, d) - atom->prox_diagonal(z, d)) / step;
          const Vector backward = (atom->prox_diagonal(z, d) - atom->prox_diagonal(z - h, d)) / step;
          if ((forward - backward).norm() > 1e-3) continue;  // a kink
          CAPTURE(text);
          CAPTURE(z.transpose());
          CHECK((0.5 * (forward + backward) - J.col(j)).norm() <= 1e-4);
        }
      }
    }
  }
}
