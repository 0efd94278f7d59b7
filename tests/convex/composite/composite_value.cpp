#include <doctest/doctest.h>

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "tests/convex/composite/extended_truth.hpp"
#include "tests/convex/composite/sample_atoms.hpp"

using convex::GraphForm;
using convex::GraphValue;
using convex::Metric;
using convex::Prox;
using convex::SparseMatrix;
using convex::Status;
using namespace samples;

namespace {

GraphForm cube(double lower, double upper) {
  return graph<Box>(2, Vector(Vector::Constant(2, lower)), Vector(Vector::Constant(2, upper)));
}

GraphForm point(const Vector& p) { return convex::graph_of(convex::point_atom(p), p.size()); }

}  // namespace

TEST_CASE("a value by minimisation is the value by formula") {
  const Vector x = Eigen::Vector3d(3, -4, 12);
  const GraphForm norm2 = graph<Norm2>(3), norm1 = graph<Norm1>(3), exponential = graph<Exponential>(3);
  const Vector one = Vector::Ones(3);
  const GraphForm cases[] = {convex::inf_convolution(norm2, convex::scale(norm2, 2)),
                             convex::inf_convolution(norm1, graph<Box>(3, Vector(-one), one)),
                             convex::inf_convolution(exponential, exponential),
                             convex::envelope(norm2, Metric::diagonal(2 * one)),
                             convex::proximal_average(norm1, norm1, 0.25, 3, Metric::identity(3))};
  const double halves = 2 * (std::exp(1.5) + std::exp(-2.0) + std::exp(6.0));
  const double values[] = {13, 2 + 3 + 11, halves, 13 - 0.25, 19};
  for (std::size_t i = 0; i < std::size(values); ++i) {
    CAPTURE(i);
    const GraphValue found = evaluate(cases[i], x);
    CHECK(found.status == Status::solved);
    CHECK(std::abs(found.value - values[i]) <= std::min(found.error_bound, 1e-13 * values[i]));
    // The subgradient gives a lower bound everywhere.
    REQUIRE(found.v);
    std::mt19937 generator(5);
    for (int count = 0; count < 5; ++count) {
      const Vector other = x + random_vector(generator, 3);
      CHECK(evaluate(cases[i], other).value >= found.value + found.v->dot(other - x) - 1e-11 * values[i]);
    }
  }
}

TEST_CASE("the conjugate of sum exp(Ax + 1) has the entropy's value on the range of A', +inf off it") {
  SparseMatrix A(2, 3);
  A.insert(0, 0) = 1;
  A.insert(0, 1) = 2;
  A.insert(1, 2) = 3;
  A.insert(1, 0) = -1;
  const Vector p = Eigen::Vector2d(0.7, 1.9), y = A.transpose() * p;
  for (double weight : {1e-6, 1.0, 1e6}) {
    CAPTURE(weight);
    const GraphForm f = convex::scale(convex::precompose(graph<Exponential>(2), A, Vector::Ones(2)), weight);
    const double value = weight * (p.array() * p.array().log() - 2 * p.array()).sum();
    const GraphValue on = evaluate(convex::conjugate(f), weight * y);
    CHECK(on.status == Status::solved);
    CHECK(std::abs(on.value - value) <= 1e-13 * std::abs(value));
    CHECK(evaluate(convex::conjugate(f), weight * (y + 1e-3 * Vector::Unit(3, 0))).value == infinity);
  }
}

TEST_CASE("a point that misses a domain by a rounding is in it, one that misses by 1e-3 is not") {
  const GraphForm square = convex::inf_convolution(cube(0, 1), cube(0, 0.5));
  const Vector corner = Vector::Constant(2, 1.5);
  CHECK(evaluate(square, corner * (1 + 1e-15)).value <= 0);
  CHECK(evaluate(square, corner * 1.001).value == infinity);
  CHECK(evaluate(convex::precompose(point(Vector::Ones(2)),
                                    SparseMatrix(3 * Matrix::Identity(2, 2).sparseView()), Vector::Zero(2)),
                 Vector::Constant(2, 1.0 / 3))
            .value <= 0);
}

TEST_CASE("a minimum of -inf is told from a value") {
  const Vector slope = Eigen::Vector2d(1, 2);
  const GraphForm up = convex::graph_of(convex::linear_atom(slope), 2),
                  down = convex::graph_of(convex::linear_atom(-slope), 2);
  CHECK(evaluate(convex::inf_convolution(up, down), slope).value == -infinity);
  // 0 is approached and not reached: no value is called exact.
  CHECK(evaluate(convex::inf_convolution(graph<Exponential>(2), graph<Norm1>(2)), slope).value >= 0);
}

TEST_CASE("domains that do not meet are infeasible, and domains that touch are not") {
  const Vector z = Eigen::Vector2d(0.3, 2);
  const auto found = [&](const GraphForm& f, const GraphForm& g) {
    const GraphForm both[] = {f, g};
    return prox(convex::sum(both), z, Metric::identity(2));
  };
  const auto status = [&](const GraphForm& f, const GraphForm& g) { return found(f, g).status; };
  CHECK(status(cube(0, 1), point(Vector::Constant(2, 2))) == Status::infeasible);
  CHECK(status(cube(0, 1), cube(1.001, 2)) == Status::infeasible);
  CHECK(status(cube(0, 1), point(Vector::Ones(2))) == Status::solved);
  CHECK(status(cube(0, 1), cube(1, 2)) == Status::solved);
  CHECK(status(graph<SecondOrderCone>(2),
               convex::precompose(graph<SecondOrderCone>(2),
                                  SparseMatrix(-Matrix::Identity(2, 2).sparseView()), Vector::Zero(2))) ==
        Status::solved);
  // No subgradient of entropy at 0, so that multipliers do not exist; the point is the set's all the same.
  CHECK(found(graph<Entropy>(2), point(Vector::Zero(2))).x == Vector::Zero(2));
}
