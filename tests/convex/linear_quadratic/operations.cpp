#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "convex/invalid_input.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/properness.hpp"
#include "convex/linear_quadratic/prox.hpp"
#include "convex/linear_quadratic/sets.hpp"
#include "convex/linear_quadratic/value.hpp"
#include "tests/convex/linear_quadratic/samples.hpp"

using convex::Index;
using convex::InvalidInput;
using convex::LinearQuadratic;
using convex::Matrix;
using convex::Metric;
using convex::Prox;
using convex::Status;
using convex::Vector;
namespace lq = convex::linear_quadratic;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void check_same(const LinearQuadratic& f, const LinearQuadratic& g, std::mt19937& generator) {
  for (int repeat = 0; repeat < 4; ++repeat) {
    const Metric W = samples::random_metric(generator, f.n, 100);
    const Vector z = samples::tied_point(generator, f.n, 1);
    const Prox x = prox(f, z, W), y = prox(g, z, W);
    REQUIRE(x.status == Status::solved);
    REQUIRE(y.status == Status::solved);
    CHECK((x.x - y.x).norm() <= 1e-12 * (1 + z.norm()));
    const double a = value(f, x.x), b = value(g, x.x);
    CHECK(std::abs(a - b) <= 1e-12 * (1 + std::abs(a)));
  }
}

}  // namespace

TEST_CASE("the conjugate of a sum is the inf-convolution of the conjugates") {
  std::mt19937 generator(21);
  const Index n = 3;
  const std::vector<LinearQuadratic> functions{lq::norm1(n, 1), lq::max(n), lq::huber(n, 1),
                                               lq::total_variation(n, 1), lq::ball_inf(n, 2)};
  for (const LinearQuadratic& f : functions)
    for (const LinearQuadratic& g : functions) {
      const LinearQuadratic both[] = {f, g};
      check_same(lq::conjugate(lq::sum(both)), lq::inf_convolution(lq::conjugate(f), lq::conjugate(g)),
                 generator);
    }
}

TEST_CASE("operations take the values that their definitions say") {
  std::mt19937 generator(22);
  const Index n = 3;
  Matrix A(3, 3);
  A << 1, 2, 0, 0, 1, -1, 3, 0, 1;
  const Vector b = Eigen::Vector3d(1, -2, 0.5), by = Eigen::Vector3d(2, 0, -1);
  for (const auto& [name, f] : samples::catalogue(n)) {
    CAPTURE(name);
    const LinearQuadratic g = lq::norm_inf(n, 1);
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Vector x = samples::tied_point(generator, n, 1);
      const auto same = [](double a, double c) {
        return a == c || std::abs(a - c) <= 1e-12 * (1 + std::abs(a) + std::abs(c));
      };
      const LinearQuadratic both[] = {f, g};
      CHECK(same(value(lq::sum(both), x), value(f, x) + value(g, x)));
      CHECK(same(value(lq::translate(f, by), x), value(f, x - by)));
      CHECK(same(value(lq::tilt(f, by), x), value(f, x) + by.dot(x)));
      CHECK(same(value(lq::scale(f, 2.5), x), 2.5 * value(f, x)));
      CHECK(same(value(lq::dilate(f, -4), x), value(f, -x / 4)));
      CHECK(same(value(lq::precompose(f, A.sparseView(), b), x), value(f, A * x + b)));
      if (f.polyhedral()) CHECK(same(value(lq::pointwise_max(both), x), std::max(value(f, x), value(g, x))));
      Vector pair(2 * n);
      pair << x, by;
      CHECK(same(value(lq::separable(both), pair), value(f, x) + value(g, by)));
    }
  }
}

TEST_CASE("an envelope is the value of the problem that defines the prox, and its gradient the step") {
  std::mt19937 generator(23);
  const Index n = 3;
  const double gamma = 0.5;
  for (const auto& [name, f] : samples::catalogue(n)) {
    CAPTURE(name);
    const Metric W = samples::random_metric(generator, n, 10);
    const Vector z = samples::tied_point(generator, n, 1);
    const LinearQuadratic smooth = lq::envelope(f, gamma, W);
    const Metric step = W.scaled(1 / gamma);
    const Vector x = prox(f, z, step).x;
    const lq::Evaluation at = evaluate(smooth, z);
    REQUIRE(at.v.has_value());
    CHECK(std::abs(at.value - value(f, x) - 0.5 * std::pow(step.norm(z - x), 2)) <=
          1e-12 * (1 + std::abs(at.value)));
    CHECK((*at.v - step.multiply(z - x)).norm() <= 1e-11 * (1 + at.v->norm()));
  }
}

TEST_CASE("the envelope of a proximal average is the average of the envelopes") {
  std::mt19937 generator(24);
  const Index n = 2;
  for (const auto& [name, f] : samples::catalogue(n)) {
    CAPTURE(name);
    const LinearQuadratic g = lq::norm1(n, 2);
    const Metric W = samples::random_metric(generator, n, 10);
    const Vector z = samples::tied_point(generator, n, 1);
    const double t = 0.25, gamma = 2;
    const double mean =
        t * value(lq::envelope(f, gamma, W), z) + (1 - t) * value(lq::envelope(g, gamma, W), z);
    const LinearQuadratic average = lq::proximal_average(f, g, t, gamma, W);
    CHECK(std::abs(value(lq::envelope(average, gamma, W), z) - mean) <= 1e-12 * (1 + std::abs(mean)));
    const Metric step = W.scaled(1 / gamma);
    const Vector between = t * prox(f, z, step).x + (1 - t) * prox(g, z, step).x;
    CHECK((prox(average, z, step).x - between).norm() <= 1e-12 * (1 + z.norm()));
  }
}

TEST_CASE("whatever operations make of two functions, its prox and its conjugate's add up to the point") {
  std::mt19937 generator(26);
  const Index n = 2;
  const Metric I = Metric::identity(n);
  const std::vector<samples::Named> all = samples::catalogue(n);
  int proper = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (int operation = 0; operation < 6; ++operation) {
      const auto& [name, g] = all[(i * 7 + static_cast<std::size_t>(operation) * 11 + 3) % all.size()];
      const LinearQuadratic& f = all[i].f;
      const LinearQuadratic both[] = {f, g};
      const LinearQuadratic made[] = {lq::sum(both),
                                      lq::inf_convolution(f, g),
                                      lq::envelope(lq::conjugate(f), 2, I),
                                      lq::proximal_average(f, lq::conjugate(g), 0.75, 0.5, I),
                                      lq::conjugate(lq::inf_convolution(f, lq::dilate(g, -2))),
                                      lq::inf_convolution(lq::envelope(f, 1, I), g)};
      CAPTURE(all[i].name);
      CAPTURE(name);
      CAPTURE(operation);
      const LinearQuadratic& h = made[operation];
      if (properness(h) != lq::Defect::none) continue;
      ++proper;
      const Metric W = samples::random_metric(generator, n, 1e3);
      const Vector z = samples::tied_point(generator, n, 1);
      const Prox x = prox(h, z, W), y = prox(lq::conjugate(h, W), z, W);
      CHECK(x.status == Status::solved);
      CHECK(y.status == Status::solved);
      CHECK(W.norm(x.x + y.x - z) <= 1e-13 * W.norm(z));
    }
  CHECK(proper > 120);
}

TEST_CASE("pieces take the value of their own polynomial, and +inf where they say so") {
  Vector breaks(3);
  breaks << -1, 0, 2;
  Matrix rows(4, 3);
  rows << infinity, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, -2;
  const LinearQuadratic f = lq::separable_pieces(1, breaks, rows);
  const auto at = [&](double x) { return value(f, Vector::Constant(1, x)); };
  CHECK(at(-1.5) == infinity);
  for (double x : {-1.0, -0.5, 0.0, 0.5, 2.0, 3.0, 1e6}) {
    const double truth = x < 0 ? x * x / 2 : x < 2 ? x : x * x - 2;
    CHECK(std::abs(at(x) - truth) <= 4e-16 * truth);
  }
}

TEST_CASE("a value is finite at a rounded point of the domain, and +inf at a point outside") {
  std::mt19937 generator(25);
  const Index n = 4;
  for (const auto& [name, f] : samples::catalogue(n)) {
    CAPTURE(name);
    const Metric W = samples::random_metric(generator, n, 1e6);
    const Prox found = prox(f, samples::tied_point(generator, n, 1e3), W);
    CHECK(std::isfinite(value(f, found.x)));
    CHECK(std::isfinite(value(lq::conjugate(f), found.v)));
  }
  CHECK(value(lq::ball1(2, 1), Eigen::Vector2d(0.6, 0.4 + 1e-6)) == infinity);
  CHECK(value(lq::conjugate(lq::norm1(2, 1)), Eigen::Vector2d(1, 1 + 1e-6)) == infinity);
  CHECK(value(lq::conjugate(lq::norm1(2, 1)), Eigen::Vector2d(1, 1 + 1e-12)) == doctest::Approx(0));
}

TEST_CASE("improper functions are told from proper ones, with the reason") {
  const Index n = 2;
  const Vector one = Vector::Ones(n), z = Vector::Zero(n);
  const Metric I = Metric::identity(n);
  const LinearQuadratic apart[] = {lq::halfspace(one, -1), lq::halfspace(-one, -1)};
  CHECK(properness(lq::sum(apart)) == lq::Defect::empty_domain);
  CHECK(prox(lq::sum(apart), z, I).status == Status::infeasible);
  const LinearQuadratic falling = lq::inf_convolution(lq::linear(one), lq::norm1(n, 0.5));
  CHECK(properness(falling) == lq::Defect::unbounded_below);
  const Prox none = prox(falling, z, I);
  CHECK(none.status == Status::infeasible);
  CHECK(none.method == "active set: the function is -inf");
  CHECK(value(falling, z) == -infinity);
  CHECK_THROWS_AS(require_proper(falling, "inf_convolution"), InvalidInput);
  for (const auto& [name, f] : samples::catalogue(3)) {
    CAPTURE(name);
    CHECK(properness(f) == lq::Defect::none);
    CHECK(properness(lq::conjugate(f)) == lq::Defect::none);
  }
}

TEST_CASE("data that make no convex function are refused with the name of what is wrong") {
  const Vector one = Vector::Ones(2);
  Matrix saddle(2, 2);
  saddle << 1, 0, 0, -1;
  CHECK_THROWS_AS(lq::quadratic(saddle, one), InvalidInput);
  CHECK_THROWS_AS(lq::ball1(2, -1), InvalidInput);
  CHECK_THROWS_AS(lq::simplex(2, -1), InvalidInput);
  CHECK_THROWS_AS(lq::box(one, -one), InvalidInput);
  CHECK_THROWS_AS(lq::sum_largest(3, 4), InvalidInput);
  CHECK_THROWS_AS(lq::huber(2, 0), InvalidInput);
  CHECK_THROWS_AS(lq::norm1(2, -1), InvalidInput);
  CHECK_THROWS_AS(lq::affine(Matrix::Ones(2, 2), Eigen::Vector2d(0, 1)), InvalidInput);
  CHECK_THROWS_AS(lq::polyhedron(saddle.rowwise().replicate(1), Eigen::Vector2d(infinity, -infinity)),
                  InvalidInput);
  Matrix rows(2, 3);
  rows << 0, 1, 0, 0, -1, 0;
  CHECK_THROWS_AS(lq::separable_pieces(1, Vector::Zero(1), rows), InvalidInput);
  rows << 0, -1, 0, 0, 1, 1;
  CHECK_THROWS_AS(lq::separable_pieces(1, Vector::Zero(1), rows), InvalidInput);
  const LinearQuadratic both[] = {lq::squared_norm2(2, 1), lq::squared_norm2(2, 2)};
  CHECK_THROWS_AS(lq::pointwise_max(both), InvalidInput);
  CHECK_THROWS_AS(prox(lq::norm1(2, 1), Vector::Zero(3), Metric::identity(3)), InvalidInput);
}
