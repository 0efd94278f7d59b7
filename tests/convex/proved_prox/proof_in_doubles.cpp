#include "convex/proved_prox/proof_in_doubles.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <set>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/proved_prox/doubles/near_graph.hpp"

using namespace convex;

namespace {

std::vector<std::string> examples() {
  std::vector<std::string> all;
  for (const CatalogueEntry& entry : catalogue())
    for (const std::string_view example : entry.examples) all.emplace_back(example);
  return all;
}

std::vector<Metric> metrics_of(Index n) {
  Matrix full = 2 * Matrix::Identity(n, n);
  for (Index i = 1; i < n; ++i) full(i, i - 1) = full(i - 1, i) = -0.75;
  return {Metric::identity(n), Metric::diagonal(Vector::LinSpaced(n, 0.7, 2.9)), Metric::dense(full)};
}

/// Points in general position, and with equal entries, zeros, and corners.
std::vector<Vector> points_of(Index n) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  std::vector<Vector> points;
  for (const double scale : {0.3, 2.0}) {
    Vector z(n);
    for (double& entry : z) entry = scale * normal(generator);
    points.push_back(z);
  }
  Vector ties(n);
  for (Index i = 0; i < n; ++i) ties[i] = 0.5 * static_cast<double>((i * 3) % 4) - 0.5;
  points.push_back(ties);
  points.push_back(Vector::Zero(n));
  return points;
}

struct Trial {
  Call call;
  Metric W;
  Vector z;
  Decomposition split;
};

/// All examples of the catalogue whose decomposition is solved.
template <class Look>
void each_trial(const Look& look) {
  for (const std::string& text : examples()) {
    const Call call = cli::parse_call(text, "f");
    const Index n = cli::number_of_entries(call);
    for (const Metric& W : metrics_of(n)) {
      try {
        const Function f = make_function(call, {W});
        for (const Vector& z : points_of(n)) {
          Decomposition split = decompose(f, z, W);
          if (split.status != Status::solved) continue;
          CAPTURE(text);
          look(Trial{call, W, z, std::move(split)});
        }
      } catch (const InvalidInput&) {  // a metric that couples blocks which depend on it
      }
    }
  }
}

std::optional<ProvedSplit> in_doubles(const Trial& one, const Decomposition& split) {
  return proof_in_doubles({one.call, one.z, Vector::Zero(one.z.size()), one.W, 0}, split);
}

bool meet(const ProvedInterval& a, const ProvedInterval& b) { return a.low <= b.high && b.low <= a.high; }

}  // namespace

TEST_CASE("proofs in doubles cover the distance to the exact prox of piecewise linear-quadratic functions") {
  std::set<std::string> proved;
  each_trial([&](const Trial& one) {
    const SplitQuestion question{one.call, fractions(one.z), exact_gram(one.W)};
    if (!exact_program(question.f, question.W)) return;
    const auto proof = in_doubles(one, one.split);
    if (!proof) return;
    proved.insert(to_text(one.call));
    const ExactSplit exact = exact_split(question);
    const ProvedMetric W(question.W);
    CHECK(W.norm_above(difference(fractions(one.split.x.x), exact.x)) <= proof->x_bound * (1 + 1e-12));
    CHECK(W.norm_above(difference(fractions(one.split.y.x), exact.y)) <= proof->y_bound * (1 + 1e-12));
    const auto holds = [](const ProvedInterval& interval, const Fraction& value) {
      return !(value < fraction(interval.low)) && !(fraction(interval.high) < value);
    };
    CHECK(holds(proof->f_x, exact.f_x));
    CHECK(holds(proof->g_y, exact.g_y));
    CHECK(holds(proof->inner, exact.inner));
    CHECK(proof->error_bound() <= 1e-10 * std::max(1.0, one.W.norm(one.z)));
  });
  CHECK(proved.size() >= 40);
}

TEST_CASE("of an x that is off, and of a y, doubles prove no less than that") {
  std::set<std::string> proved, planted_at;
  each_trial([&](const Trial& one) {
    const auto proof = in_doubles(one, one.split);
    if (!proof) return;
    proved.insert(to_text(one.call));
    // Less than what is left to fractions, and far more than a rounding.
    constexpr double planted = 3e-11;
    const Vector step = planted * Vector::Unit(one.z.size(), 0) / one.W.norm(Vector::Unit(one.z.size(), 0));
    Decomposition wrong_x = one.split, wrong_y = one.split;
    wrong_x.x.x += step;
    wrong_y.y.x += step;
    const auto of_x = in_doubles(one, wrong_x), of_y = in_doubles(one, wrong_y);
    if (of_x) CHECK(of_x->x_bound + proof->x_bound >= planted * 0.999);
    if (of_y) CHECK(of_y->y_bound + proof->y_bound >= planted * 0.999);
    if (of_x || of_y) planted_at.insert(to_text(one.call));
  });
  CHECK(proved.size() >= 90);
  CHECK(planted_at.size() >= 80);
}

TEST_CASE("a pair near any point and covector lies on the graph: it is the resolvent of its own sum") {
  std::set<std::string> found;
  each_trial([&](const Trial& one) {
    const Index n = one.z.size();
    const Metric plain = Metric::identity(n);
    const Function f = make_function(one.call, {one.W});
    for (const double t : {0.0, 0.25, 1.0}) {
      const Vector x = one.split.x.x + t * Vector::LinSpaced(n, -0.5, 1), v = t * one.z + one.split.x.v;
      const auto pair = near_graphs::near_graph(one.call, one.W, x, v);
      if (!pair) continue;
      const Prox again = f.prox(pair->x + pair->v, plain);
      if (again.status != Status::solved) continue;
      found.insert(to_text(one.call));
      const double off = std::sqrt(2 * pair->gap) + pair->x_radius.norm() + pair->v_radius.norm() +
                         pair->x_ball + pair->v_ball + 1e-9 * (1 + x.norm() + v.norm()) + again.error_bound;
      CHECK((again.x - pair->x).norm() <= off);
      CHECK(pair->f_x.low <= pair->f_x.high);
      // f(x') where the domain has room for the rounding of x'.
      const double value = f(pair->x);
      if (std::isfinite(value)) {
        CHECK(value >= pair->f_x.low - 1e-8 * (1 + std::abs(value) + off));
        CHECK(value <= pair->f_x.high + 1e-8 * (1 + std::abs(value) + off));
      }
    }
  });
  CHECK(found.size() >= 90);
}

TEST_CASE("numbers that are written as no double can be have their rounding counted") {
  // A third and a tenth: the exact prox in fractions, the doubles beside it.
  const Call call = cli::parse_call("norm1(weight=0.1)", "f");
  SplitQuestion question{call, {Fraction{1, 3}, Fraction{-2, 3}, Fraction{1, 10}}, identity_gram(3)};
  const Metric W = Metric::identity(3);
  const Vector z = nearest(question.z);
  const Decomposition split = decompose(make_function(call, {W}), z, W);
  const Vector rounding = z.cwiseAbs() * unit_roundoff;
  const auto proof = proof_in_doubles({call, z, rounding, W, 0}, split);
  REQUIRE(proof);
  const ExactSplit exact = exact_split(question);
  const ProvedMetric exact_metric(question.W);
  CHECK(exact_metric.norm_above(difference(fractions(split.x.x), exact.x)) <= proof->x_bound);
  CHECK(exact_metric.norm_above(difference(fractions(split.y.x), exact.y)) <= proof->y_bound);
  // Had the texts counted as doubles, |x_2| = 0 and |x_1| - 1/3 + 1/10 would have been exact.
  CHECK(proof->x_bound > 0);
  CHECK(meet(proof->f_x, outwards(exact.f_x, exact.f_x)));
}

TEST_CASE("functions of eigenvalues are proved also where these are 0 to rounding, or equal") {
  std::mt19937_64 generator(9);
  std::normal_distribution<double> normal;
  const Index k = 4;
  for (const char* text : {"max_eigenvalue(0.5)", "indicator(spectraplex(1))", "indicator(psd_cone())",
                           "nuclear_norm(1, 4)", "schatten(inf, rows=4)", "indicator(spectral_ball(1, 4))"})
    for (int trial = 0; trial < 6; ++trial) {
      CAPTURE(text);
      CAPTURE(trial);
      Matrix M = Matrix::Zero(k, k);
      for (Index i = 0; i < k; ++i)
        for (Index j = 0; j <= i; ++j) M(i, j) = M(j, i) = normal(generator);
      if (trial % 3 == 0) M = Vector{{1, 1, -1, 0.5}}.asDiagonal();
      const Vector z = M.reshaped();
      const Metric W = Metric::identity(k * k);
      const Call call = cli::parse_call(text, "f");
      const Decomposition split = decompose(make_function(call, {W}), z, W);
      const auto proof = proof_in_doubles({call, z, Vector::Zero(k * k), W, 0}, split);
      REQUIRE(proof);
      CHECK(proof->error_bound() <= 1e-12 * std::max(1.0, z.norm()));
    }
}

TEST_CASE("a proof in doubles of a large decomposition has at least twelve digits") {
  const Index n = 400;
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  Vector z(n);
  for (double& entry : z) entry = normal(generator);
  const Metric W = Metric::diagonal(Vector::LinSpaced(n, 0.5, 2));
  for (const char* text : {"norm1(0.7)", "huber(0.5)", "entropy()", "logistic()", "indicator(simplex(1))",
                           "norm_inf()", "indicator(ball1(3))", "total_variation(0.3)", "sum_largest(10)",
                           "indicator(box(-0.5, 1))", "log_sum_exp()"}) {
    CAPTURE(text);
    const Call call = cli::parse_call(text, "f");
    const Decomposition split = decompose(make_function(call, {W}), z, W);
    const auto proof = proof_in_doubles({call, z, Vector::Zero(n), W, 0}, split);
    REQUIRE(proof);
    CHECK(proof->error_bound() <= 1e-12 * W.norm(z));
    CHECK(proof->level == ProofLevel::enclosure);
  }
}
