#include "convex/composite/composite_prox.hpp"

#include <doctest/doctest.h>

#include "convex/composite/graph_algebra.hpp"
#include "tests/convex/composite/extended_truth.hpp"
#include "tests/convex/composite/sample_atoms.hpp"

using convex::GraphForm;
using convex::Metric;
using convex::Prox;
using convex::Status;
using namespace samples;

namespace {

/// Metrics of all conditions and sizes, points of all sizes.
template <class Body>
void on_samples(Index smallest, const Body& body) {
  for (double condition : {1.0, 1e3, 1e6})
    for (unsigned seed = 0; seed < 24; ++seed) {
      CAPTURE(condition);
      CAPTURE(seed);
      std::mt19937 generator(seed);
      const Index n = smallest + seed % 6;
      const Metric W = random_metric(generator, n, condition, std::pow(10.0, static_cast<int>(seed % 5) - 2));
      body(W, random_vector(generator, n, std::pow(10.0, static_cast<int>(seed % 4) - 1)));
    }
}

const auto no_gradient = [](const ExtendedVector& x) {
  return ExtendedVector(ExtendedVector::Zero(x.size()));
};
const auto no_hessian = [](const ExtendedVector& x) {
  return ExtendedMatrix(ExtendedMatrix::Zero(x.size(), x.size()));
};

/// The conditions x_i = value_i for the i where `fixed`.
Conditions with_fixed(Conditions conditions, const Vector& value, const std::vector<Index>& fixed) {
  const Index m = static_cast<Index>(fixed.size());
  conditions.A = Matrix::Zero(m, value.size());
  conditions.b.resize(m);
  for (Index row = 0; row < m; ++row) {
    const Index i = fixed[static_cast<std::size_t>(row)];
    conditions.A(row, i) = 1;
    conditions.b[row] = value[i];
  }
  return conditions;
}

ExtendedVector unit(const ExtendedVector& x) { return x / x.norm(); }
ExtendedMatrix unit_slope(const ExtendedVector& x) {
  return (ExtendedMatrix::Identity(x.size(), x.size()) - unit(x) * unit(x).transpose()) / x.norm();
}

}  // namespace

TEST_CASE("the Euclidean norm has its prox to 1e-12 in metrics of condition 1e6") {
  on_samples(1, [](const Metric& W, const Vector& z) {
    const Prox found = prox(graph<Norm2>(z.size()), z, W);
    if (found.x.norm() > 0) {
      check_accuracy(found, truth(W.dense_gram(), z, {unit, unit_slope, {}, {}}, found.x).x, W, z);
    } else {  // Wz is a subgradient at 0
      CHECK(W.multiply(z).norm() <= 1 + 1e-12);
      CHECK(found.error_bound <= 1e-12 * W.norm(z));
    }
  });
}

TEST_CASE("the 1-norm has its prox to 1e-12, its zeros exact") {
  on_samples(1, [](const Metric& W, const Vector& z) {
    const Prox found = prox(graph<Norm1>(z.size()), z, W);
    std::vector<Index> zeros;
    for (Index i = 0; i < z.size(); ++i)
      if (std::abs(found.x[i]) <= 0) zeros.push_back(i);
    const auto signs = [&](const ExtendedVector& x) {
      return ExtendedVector(x.unaryExpr([](const Extended& a) {
        return Extended(a > 0 ? 1 : a < 0 ? -1 : 0);
      }));
    };
    // Signs away from 0 only: rows keep the zeros where they are.
    const Truth exact = truth(W.dense_gram(), z,
                              with_fixed({[&](const ExtendedVector& x) {
                                            ExtendedVector s = signs(x);
                                            for (Index i : zeros) s[i] = 0;
                                            return s;
                                          },
                                          no_hessian,
                                          {},
                                          {}},
                                         Vector::Zero(z.size()), zeros),
                              found.x);
    for (const Extended& multiplier : exact.lambda) CHECK(abs(multiplier) <= 1 + 1e-9);
    for (Index i = 0; i < z.size(); ++i) CHECK(exact.x[i] * found.x[i] >= 0);
    check_accuracy(found, exact.x, W, z);
  });
}

TEST_CASE("a box has its projection to 1e-12, its bounds exact") {
  on_samples(1, [](const Metric& W, const Vector& z) {
    const Index n = z.size();
    const Vector lower = Vector::Constant(n, -0.3), upper = Vector::Constant(n, 0.5);
    const Prox found = prox(graph<Box>(n, lower, upper), z, W);
    std::vector<Index> fixed;
    for (Index i = 0; i < n; ++i)
      if (found.x[i] <= lower[i] || found.x[i] >= upper[i]) fixed.push_back(i);
    const Truth exact =
        truth(W.dense_gram(), z, with_fixed({no_gradient, no_hessian, {}, {}}, found.x, fixed), found.x);
    for (std::size_t row = 0; row < fixed.size(); ++row) {
      const Extended multiplier = exact.lambda[static_cast<Index>(row)];
      const bool at_upper = found.x[fixed[row]] >= upper[fixed[row]];
      CHECK((at_upper ? multiplier : -multiplier) >= -1e-9 * W.dual_norm(W.multiply(z)));
    }
    check_accuracy(found, exact.x, W, z);
  });
}

TEST_CASE("exponentials, entropy and a barrier with an open domain have their proxes to 1e-12") {
  const auto exponential = [](const ExtendedVector& x) { return ExtendedVector(x.array().exp()); };
  const auto entropy = [](const ExtendedVector& x) { return ExtendedVector(x.array().log() + 1); };
  const auto barrier = [](const ExtendedVector& x) { return ExtendedVector(-x.array().inverse()); };
  on_samples(1, [&](const Metric& W, const Vector& z) {
    const Index n = z.size();
    const Prox of_exponential = prox(graph<Exponential>(n), z, W);
    const auto exponential_slope = [](const ExtendedVector& x) {
      return ExtendedMatrix(ExtendedVector(x.array().exp()).asDiagonal());
    };
    check_accuracy(of_exponential,
                   truth(W.dense_gram(), z, {exponential, exponential_slope, {}, {}}, of_exponential.x).x, W,
                   z);
    const Prox of_entropy = prox(graph<Entropy>(n), z, W);
    const auto entropy_slope = [](const ExtendedVector& x) {
      return ExtendedMatrix(ExtendedVector(x.array().inverse()).asDiagonal());
    };
    if (of_entropy.x.minCoeff() > 1e-250)  // else the logarithm's argument has no digits left
      check_accuracy(of_entropy, truth(W.dense_gram(), z, {entropy, entropy_slope, {}, {}}, of_entropy.x).x,
                     W, z);
    const Prox of_barrier = prox(graph<LogBarrier>(n), z, W);
    const auto barrier_slope = [](const ExtendedVector& x) {
      return ExtendedMatrix(ExtendedVector(x.array().square().inverse()).asDiagonal());
    };
    check_accuracy(of_barrier, truth(W.dense_gram(), z, {barrier, barrier_slope, {}, {}}, of_barrier.x).x, W,
                   z);
  });
}

TEST_CASE("a second-order cone splits z in any metric into a point of the cone and one of its polar") {
  on_samples(2, [](const Metric& W, const Vector& z) {
    const Index n = z.size();
    const Prox found = prox(graph<SecondOrderCone>(n), z, W);
    const Vector x = found.x, y = W.multiply(z - x);
    const double size = W.norm(z), covector = W.dual_norm(y) + W.dual_norm(W.multiply(x));
    CHECK(found.status == Status::solved);
    CHECK(x.head(n - 1).norm() <= x[n - 1] + 1e-13 * x.norm());
    CHECK(found.v.head(n - 1).norm() <= -found.v[n - 1] + 1e-13 * found.v.norm());
    CHECK(std::abs(x.dot(found.v)) <= 1e-12 * x.norm() * found.v.norm());
    CHECK(W.dual_norm(found.v - y) <= 1e-12 * covector);
    CHECK(found.error_bound <= 1e-12 * size);
  });
}

TEST_CASE("a metric of condition 1e12 is never silently wrong") {
  for (unsigned seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    std::mt19937 generator(seed);
    const Index n = 2 + seed % 5;
    const Metric W = random_metric(generator, n, std::pow(10.0, 7 + seed % 6));
    const Vector z = random_vector(generator, n);
    const Prox found = prox(graph<Exponential>(n), z, W);
    const auto exact = truth(
        W.dense_gram(), z,
        {[](const ExtendedVector& x) { return ExtendedVector(x.array().exp()); },
         [](const ExtendedVector& x) { return ExtendedMatrix(ExtendedVector(x.array().exp()).asDiagonal()); },
         {},
         {}},
        found.x);
    const double size = W.norm(z) + W.norm(found.x);
    CHECK(error(W.dense_gram(), found.x, exact.x) <= found.error_bound);
    CHECK((found.status == Status::inaccurate) == (found.error_bound > 1e-12 * size));
    CHECK(found.error_bound <= 1e-8 * size);
  }
}

TEST_CASE("a prox scales with its point and its function, to the ends of the range of doubles") {
  std::mt19937 generator(3);
  const Metric W = random_metric(generator, 4, 100);
  const Vector z = random_vector(generator, 4, 5);
  const Vector x = prox(graph<Norm2>(4), z, W).x;
  for (double factor : {0x1p-450, 0x1p-60, 0x1p-20, 0x1p20, 0x1p60, 0x1p450}) {
    CAPTURE(factor);
    // prox of c f at c z is c prox_f z for f of degree 1; in the metric c W that of c f at z is prox_f z.
    const Prox larger = prox(scale(graph<Norm2>(4), factor), factor * z, W);
    CHECK((larger.x / factor - x).norm() <= 1e-13 * x.norm());
    CHECK(larger.status == Status::solved);
    const Prox heavier = prox(scale(graph<Norm2>(4), factor), z, W.scaled(factor));
    CHECK((heavier.x - x).norm() <= 1e-13 * x.norm());
    CHECK(heavier.status == Status::solved);
  }
}

TEST_CASE("a graph form at a point of another size is refused") {
  CHECK_THROWS_AS(prox(graph<Norm2>(3), Vector::Ones(2), Metric::identity(2)), convex::InvalidInput);
  CHECK_THROWS_AS(prox(graph<Norm2>(3), Vector::Ones(3), Metric::identity(2)), convex::InvalidInput);
  CHECK_THROWS_AS(evaluate(graph<Norm2>(3), Vector::Ones(2)), convex::InvalidInput);
}
