#include "convex/sparse_gram.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <random>
#include <thread>

#include "convex/invalid_input.hpp"
#include "convex/metric.hpp"

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::SparseMatrix;
using convex::Vector;

namespace {

/// Springs 1 around a ring of n masses, one of which is tied to the ground by `ground`; signs: those of the
/// entries beside the diagonal.
SparseMatrix ring(Index n, double ground, double sign = -1) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < n; ++i) {
    entries.emplace_back(i, i, i == 0 ? 2 + ground : 2.0);
    entries.emplace_back(i, (i + 1) % n, sign);
    entries.emplace_back((i + 1) % n, i, sign);
  }
  SparseMatrix W(n, n);
  W.setFromTriplets(entries.begin(), entries.end());
  return W;
}

}  // namespace

TEST_CASE("a network with a path to the ground is plainly definite, and measures as its dense twin does") {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  for (double ground : {1e-3, 1.0, 40.0})
    for (double sign : {-1.0, 1.0})
      for (Index n : {3, 8, 61}) {
        CAPTURE(ground);
        CAPTURE(n);
        const SparseMatrix W = ring(n, ground, sign);
        CHECK(convex::excess_if_plainly_definite(W, 1e-12).size() == n);
        const Metric sparse = Metric::sparse(W), dense = Metric::dense(Matrix(W));
        Vector x(n);
        for (Index i = 0; i < n; ++i) x[i] = normal(generator);
        CHECK(sparse.norm(x) == doctest::Approx(dense.norm(x)).epsilon(1e-13));
        CHECK(sparse.dual_norm(x) == doctest::Approx(dense.dual_norm(x)).epsilon(1e-10));
        CHECK((sparse.solve(W * x) - x).norm() <= 1e-10 * x.norm());
      }
}

TEST_CASE("what is called plainly definite has no small pivot, whatever the order") {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> weight(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 2 + trial % 6;
    Matrix W = Matrix::Zero(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < i; ++j)
        if (weight(generator) > 0) W(i, j) = W(j, i) = weight(generator);
    for (Index i = 0; i < n; ++i) W(i, i) = W.row(i).cwiseAbs().sum() + 1e-9;
    W(0, 0) += std::exp2(4 * trial % 30) * 1e-8;
    const double least = 1e-4;
    if (convex::excess_if_plainly_definite(W.sparseView(), least).size() == 0) continue;
    // The last pivot of an elimination is one over an entry of the inverse, of W as of its leading blocks;
    // they are greatest for the whole.
    const Vector inverse = W.inverse().diagonal();
    CHECK((inverse.array() * W.diagonal().array() * least).maxCoeff() < 1);
  }
}

TEST_CASE("a network without ground, or with nearly none, is refused") {
  CHECK_THROWS_AS(Metric::sparse(ring(20, 0)), convex::InvalidInput);
  CHECK_THROWS_AS(Metric::sparse(ring(20, 0x1p-50)), convex::InvalidInput);
  CHECK(convex::excess_if_plainly_definite(ring(20, 1e-13), 1e-12).size() == 0);
}

TEST_CASE("threads that ask a new metric at once get the same bytes") {
  const Metric W = Metric::sparse(ring(400, 0.5));
  const Vector x = Vector::LinSpaced(400, -1, 2);
  std::vector<Vector> answers(4);
  std::vector<std::thread> threads;
  for (Vector& answer : answers) threads.emplace_back([&] { answer = W.solve(x); });
  for (std::thread& thread : threads) thread.join();
  for (const Vector& answer : answers) CHECK(answer == answers.front());
}
