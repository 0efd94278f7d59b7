#include "convex/composite/graph_algebra.hpp"

#include <doctest/doctest.h>

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/composite_prox.hpp"
#include "tests/convex/composite/extended_truth.hpp"
#include "tests/convex/composite/sample_atoms.hpp"

using convex::GraphForm;
using convex::Metric;
using convex::Prox;
using convex::SparseMatrix;
using convex::Status;
using namespace samples;

namespace {

GraphForm quadratic(const Matrix& Q, const Vector& c, double constant) {
  return convex::add_quadratic(GraphForm{c.size(), 0, {}, 0}, Q, c, constant);
}

/// {x : |x_i| <= radius}.
GraphForm cube(Index n, double radius) {
  return graph<Box>(n, Vector(Vector::Constant(n, -radius)), Vector(Vector::Constant(n, radius)));
}

template <class Body>
void on_samples(const Body& body) {
  for (double condition : {1.0, 1e3, 1e6})
    for (unsigned seed = 0; seed < 12; ++seed) {
      CAPTURE(condition);
      CAPTURE(seed);
      std::mt19937 generator(seed + 100);
      const Index n = 1 + seed % 5;
      const Metric W = random_metric(generator, n, condition, std::pow(10.0, static_cast<int>(seed % 3) - 1));
      body(W, random_vector(generator, n, std::pow(10.0, static_cast<int>(seed % 3) - 1)), generator);
    }
}

Matrix random_matrix(std::mt19937& generator, Index rows, Index columns) {
  Matrix A(rows, columns);
  for (Index j = 0; j < columns; ++j) A.col(j) = random_vector(generator, rows);
  return A;
}

/// Both solved, both bounds at most 1e-12 relative, and x the same within the sum of the bounds: of one prox
/// by two graph forms.
void check_same(const GraphForm& f, const GraphForm& g, const Vector& z, const Metric& W) {
  const Prox a = prox(f, z, W), b = prox(g, z, W);
  const double size = W.norm(z) + W.norm(a.x);
  CHECK(a.status == Status::solved);
  CHECK(b.status == Status::solved);
  CHECK(a.error_bound <= 1e-12 * size);
  CHECK(W.norm(a.x - b.x) <= a.error_bound + b.error_bound);
}

/// z = prox_f z + W⁻¹ prox_{g} Wz in the metrics W and W⁻¹ with g = f* (Moreau 1965). The inverse of W is
/// rounded, which costs condition roundings.
void check_conjugate(const GraphForm& f, const GraphForm& g, const Vector& z, const Metric& W,
                     double condition) {
  Matrix inverse = Matrix::Identity(z.size(), z.size());
  W.whiten_in_place(inverse);
  const Metric dual = Metric::dense(inverse.transpose() * inverse);
  const Prox primal = prox(f, z, W), polar = prox(g, W.multiply(z), dual);
  CHECK(primal.status == Status::solved);
  CHECK(polar.status == Status::solved);
  const double size = W.norm(z) + W.norm(primal.x);
  CHECK(W.norm(z - primal.x - W.solve(polar.x)) <=
        1e-12 * size + 16 * condition * convex::unit_roundoff * size);
}

}  // namespace

TEST_CASE("f + f is 2 f, though its multipliers are not unique") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937&) {
    const GraphForm twice[] = {graph<Norm1>(z.size()), graph<Norm1>(z.size())};
    check_same(convex::sum(twice), convex::scale(graph<Norm1>(z.size()), 2), z, W);
  });
}

TEST_CASE("two boxes meet in a box") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937&) {
    const Index n = z.size();
    const GraphForm both[] = {
        graph<Box>(n, Vector(Vector::Constant(n, -0.5)), Vector(Vector::Constant(n, 0.5))),
        graph<Box>(n, Vector(Vector::Constant(n, -1)), Vector(Vector::Constant(n, 0.2)))};
    check_same(convex::sum(both),
               graph<Box>(n, Vector(Vector::Constant(n, -0.5)), Vector(Vector::Constant(n, 0.2))), z, W);
  });
}

TEST_CASE("a norm of Ax + b has its prox to 1e-12") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937& generator) {
    const Index n = z.size();
    const Matrix A = random_matrix(generator, n, n) + 2 * Matrix::Identity(n, n);
    const Vector b = random_vector(generator, n, 10);
    const GraphForm f = convex::precompose(graph<Norm2>(n), A.sparseView(), b);
    const Prox found = prox(f, z, W);
    const ExtendedMatrix wide = A.cast<Extended>();
    const auto image = [&](const ExtendedVector& x) { return ExtendedVector(wide * x + b.cast<Extended>()); };
    if ((A * found.x + b).norm() < 1e-6) return;  // at the kink: another law's matter
    const Truth exact = truth(W.dense_gram(), z,
                              {[&](const ExtendedVector& x) {
                                 const ExtendedVector y = image(x);
                                 return ExtendedVector(wide.transpose() * y / y.norm());
                               },
                               [&](const ExtendedVector& x) {
                                 const ExtendedVector y = image(x), e = y / y.norm();
                                 const ExtendedMatrix K = ExtendedMatrix::Identity(n, n) - e * e.transpose();
                                 return ExtendedMatrix(wide.transpose() * K * wide / y.norm());
                               },
                               {},
                               {}},
                              found.x);
    check_accuracy(found, exact.x, W, z);
  });
}

TEST_CASE("the envelope of the norm is Huber's function of the norm") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937&) {
    const Index n = z.size();
    const GraphForm huber = convex::envelope(graph<Norm2>(n), Metric::identity(n));
    const Prox found = prox(huber, z, W);
    const bool inside = found.x.norm() <= 1;
    const Truth exact =
        truth(W.dense_gram(), z,
              {[&](const ExtendedVector& x) { return inside ? x : ExtendedVector(x / x.norm()); },
               [&](const ExtendedVector& x) {
                 const ExtendedMatrix I = ExtendedMatrix::Identity(n, n);
                 const ExtendedVector e = x / x.norm();
                 return inside ? I : ExtendedMatrix((I - e * e.transpose()) / x.norm());
               },
               {},
               {}},
              found.x);
    check_accuracy(found, exact.x, W, z);
    for (double length : {0.1, 3.0}) {
      const Vector x = length * Vector::Unit(n, 0);
      CHECK(evaluate(huber, x).value ==
            doctest::Approx(length < 1 ? length * length / 2 : length - 0.5).epsilon(1e-14));
    }
  });
}

TEST_CASE("entropy on the unit simplex, in metrics from weak to strong") {
  on_samples([](const Metric& unscaled, const Vector& z, std::mt19937&) {
    const Index n = z.size();
    SparseMatrix ones(1, n);
    for (Index i = 0; i < n; ++i) ones.insert(0, i) = 1;
    const GraphForm parts[] = {
        graph<Entropy>(n),
        convex::precompose(convex::graph_of(convex::point_atom(Vector::Ones(1)), 1), ones, Vector::Zero(1))};
    for (double step : {1e-3, 1.0, 1e6}) {
      CAPTURE(step);
      const Metric W = unscaled.scaled(1 / step);
      const Prox found = prox(convex::sum(parts), z, W);
      if (found.x.minCoeff() < 1e-200) continue;
      const Truth exact = truth(W.dense_gram(), z,
                                {[](const ExtendedVector& x) { return ExtendedVector(x.array().log() + 1); },
                                 [](const ExtendedVector& x) {
                                   return ExtendedMatrix(ExtendedVector(x.array().inverse()).asDiagonal());
                                 },
                                 Matrix(ones), Vector::Ones(1)},
                                found.x);
      check_accuracy(found, exact.x, W, z);
    }
  });
}

TEST_CASE("norms that are inf-convolved leave the smaller norm") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937&) {
    const GraphForm small = graph<Norm2>(z.size()), large = convex::scale(small, 2);
    check_same(convex::inf_convolution(small, large), small, z, W);
  });
}

TEST_CASE("the maximum of f and 2 f >= f is 2 f, and of quadratics what its conjugate says") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937&) {
    const GraphForm once = graph<Norm1>(z.size()), twice = convex::scale(once, 2);
    const GraphForm both[] = {once, twice};
    check_same(convex::pointwise_max(both), twice, z, W);
  });
  for (unsigned seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    std::mt19937 generator(seed);
    const Index n = 1 + seed % 4;
    const Matrix B = random_matrix(generator, n, n);
    const GraphForm both[] = {quadratic(B * B.transpose(), random_vector(generator, n), 0.5),
                              quadratic(Matrix::Identity(n, n), random_vector(generator, n), -1)};
    const GraphForm larger = convex::pointwise_max(both);
    const Metric W = random_metric(generator, n, 100);
    const Vector z = random_vector(generator, n, 3);
    check_conjugate(larger, convex::conjugate(larger), z, W, 100);
    const Vector x = prox(larger, z, W).x;
    const double value = std::max(evaluate(both[0], x).value, evaluate(both[1], x).value);
    CHECK(evaluate(larger, x).value == doctest::Approx(value).epsilon(1e-12));
  }
}

TEST_CASE("z splits between the proxes of a graph form and of its conjugate") {
  for (double condition : {1.0, 1e3, 1e5})
    for (unsigned seed = 0; seed < 10; ++seed) {
      CAPTURE(condition);
      CAPTURE(seed);
      std::mt19937 generator(seed);
      const Index n = 2 + seed % 4;
      const Metric W = random_metric(generator, n, condition);
      const Vector z = random_vector(generator, n, 2);
      const Matrix A = random_matrix(generator, n + 1, n);
      const Vector b = random_vector(generator, n + 1);
      const GraphForm forms[] = {
          graph<SecondOrderCone>(n), convex::precompose(graph<Exponential>(n + 1), A.sparseView(), b),
          convex::inf_convolution(graph<Norm1>(n), cube(n, 0.3)),
          convex::add_quadratic(graph<Norm2>(n), A.transpose() * A, z, 2),
          convex::precompose(convex::inf_convolution(graph<Norm2>(n + 1), cube(n + 1, 1)), A.sparseView(),
                             b)};
      for (const GraphForm& f : forms) {
        CAPTURE(&f - forms);
        check_conjugate(f, convex::conjugate(f), z, W, condition);
        check_same(convex::conjugate(convex::conjugate(f)), f, z, W);
      }
    }
}

TEST_CASE("the prox of a proximal average is the average of the proxes") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937&) {
    const Index n = z.size();
    const double lambda = 0.3, gamma = 2;
    const GraphForm f = graph<Norm1>(n), g = cube(n, 0.4);
    const Metric step = W.scaled(1 / gamma);
    const Prox found = prox(convex::proximal_average(f, g, lambda, gamma, W), z, step);
    const Prox of_f = prox(f, z, step), of_g = prox(g, z, step);
    CHECK(found.status == Status::solved);
    const Vector average = lambda * of_f.x + (1 - lambda) * of_g.x;
    Vector roundings = Vector::Zero(n);  // of the average, in the worst directions
    for (Index i = 0; i < n; ++i) roundings[i] = 4 * convex::unit_roundoff * std::abs(average[i]);
    CHECK(step.norm(found.x - average) <= found.error_bound + of_f.error_bound + of_g.error_bound +
                                              roundings.dot(step.diagonal().cwiseSqrt()));
  });
}

TEST_CASE("blocks do not see each other, and a linear term moves z") {
  on_samples([](const Metric& W, const Vector& z, std::mt19937& generator) {
    const Index n = z.size();
    const GraphForm both[] = {graph<Norm1>(n), graph<Norm2>(n)};
    Matrix wide = Matrix::Zero(2 * n, 2 * n);
    wide.topLeftCorner(n, n) = W.dense_gram();
    wide.bottomRightCorner(n, n) = 3 * W.dense_gram();
    Vector point(2 * n);
    point << z, -z;
    const Metric product = Metric::dense(wide), second = W.scaled(3);
    const Prox whole = prox(convex::blocks(both), point, product), a = prox(both[0], z, W),
               b = prox(both[1], -z, second);
    CHECK(W.norm(whole.x.head(n) - a.x) <= whole.error_bound + a.error_bound);
    CHECK(second.norm(whole.x.tail(n) - b.x) <= whole.error_bound + b.error_bound);

    const Vector shift =
        random_vector(generator, n);  // z = W⁻¹(Wz' + c) in fewer roundings by a point that is known
    const GraphForm tilted = convex::add_quadratic(both[0], Matrix::Zero(n, n), W.multiply(shift), 7);
    const Prox moved = prox(both[0], z - shift, W), found = prox(tilted, z, W);
    const double rounding =
        8 * convex::unit_roundoff * W.factor_condition() * W.factor_condition() * W.norm(shift);
    CHECK(W.norm(moved.x - found.x) <= moved.error_bound + found.error_bound + rounding * 1e3);
    CHECK(evaluate(tilted, z).value ==
          doctest::Approx(z.lpNorm<1>() + z.dot(W.multiply(shift)) + 7).epsilon(1e-12));
  });
}
