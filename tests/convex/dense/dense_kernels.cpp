#include "convex/dense/dense_kernels.hpp"

#include <doctest/doctest.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using convex::DenseKernels;
using convex::Index;
using convex::Matrix;
using convex::padded;
using convex::RowMatrix;
using convex::Vector;

namespace {

struct Data {
  Matrix A;
  RowMatrix U;
  Vector z, x, s;
  std::vector<Index> rows;
};

Data draw(Index n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto fill = [&](auto& M) {
    for (Index i = 0; i < M.size(); ++i) M.data()[i] = normal(generator);
  };
  Matrix B(n, n);
  Data data{{}, RowMatrix(n + 11, n), Vector(n), Vector::Zero(padded(n)), Vector(n + 11), {}};
  fill(B);
  fill(data.U);
  fill(data.z);
  fill(data.s);
  for (Index i = 0; i < n; ++i) data.x[i] = normal(generator);
  data.A = B * B.transpose() + Matrix::Identity(n, n);
  for (Index a = 0; a < n + 3; a += 2) data.rows.push_back(a);
  return data;
}

Matrix padded_matrix(const Matrix& A) {
  const Index n = A.rows(), ld = padded(n);
  Matrix T = Matrix::Identity(ld, ld);
  T.topLeftCorner(n, n) = A;
  return T;
}

/// All that the kernels make of the data, one after the other.
std::vector<double> outcome(const DenseKernels& kernels, const Data& data) {
  const Index n = data.z.size(), m = data.U.rows(), ld = padded(n);
  std::vector<double> all;
  const auto keep = [&](const auto& M) { all.insert(all.end(), M.data(), M.data() + M.size()); };
  Matrix T = padded_matrix(data.A);
  Vector inverse(16 * ld), x = data.x, z = Vector::Zero(ld), into(std::max(m, ld));
  z.head(n) = data.z;
  kernels.factor(n, ld, T.data(), inverse.data());
  keep(T);
  kernels.forward(n, ld, T.data(), inverse.data(), x.data());
  keep(x);
  kernels.backward(n, ld, T.data(), inverse.data(), x.data());
  keep(x);
  Matrix X(8, n), G(8, 8);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < 8; ++k) X(k, i) = data.U(k % m, i);
  kernels.precise_slacks(n, X.data(), data.x.data(), Vector(data.s.replicate(8, 1)).data(), into.data());
  keep(Vector(into.head(8)));
  kernels.forward_pack(n, ld, T.data(), inverse.data(), X.data());
  keep(X);
  kernels.backward_pack(n, ld, T.data(), inverse.data(), X.data());
  keep(X);
  kernels.gram(n, X.data(), X.data(), G.data(), 8);
  keep(G);
  kernels.slacks(m, n, data.U.data(), data.x.data(), data.s.data(), into.data());
  keep(Vector(into.head(m)));
  kernels.squares(m, n, data.U.data(), data.x.data(), into.data());
  keep(Vector(into.head(m)));
  const Index count = static_cast<Index>(data.rows.size());
  kernels.side_by_side(n, m, data.U.data(), data.rows.data(), std::min<Index>(8, count), X.data());
  keep(X);
  Vector c = Vector::LinSpaced(8 * count, -3, 5), found(24);
  if (count > 1) c.segment(8, 8).setZero();  // a row that none is a sum of
  std::vector<Index> terms(data.rows.size());
  kernels.whole_sums(n, X.data(), Vector(Vector::Ones(8)).data(), data.U.data(), data.s.data(), count,
                     data.rows.data(), Vector(Vector::Ones(m)).data(), Vector(Vector::Ones(8)).data(), 0.1,
                     c.data(), terms.data(), found.data(), found.data() + 8, found.data() + 16);
  keep(c);
  keep(found);
  kernels.stationarity(n, data.A.data(), data.x.data(), m, data.U.data(),
                       static_cast<Index>(data.rows.size()), data.rows.data(), data.s.data(), z.data(),
                       into.data());
  keep(Vector(into.head(n)));
  return all;
}

}  // namespace

TEST_CASE("the dense kernels give the same bytes for every processor family") {
  for (Index n : {1, 2, 3, 4, 5, 7, 8, 9, 16, 23, 41}) {
    const Data data = draw(n, static_cast<unsigned>(n));
    const std::vector<double> reference = outcome(convex::dense_kernels(), data);
    for (const DenseKernels* kernels : convex::all_dense_kernels())
      CHECK(outcome(*kernels, data) == reference);
  }
}

TEST_CASE("slacks and squares are sums along each row, however few entries it has") {
  for (Index n : {1, 2, 3, 4, 5, 9}) {
    const Data data = draw(n, 11);
    const Index m = data.U.rows();
    Vector slack(m), square(m);
    const DenseKernels& kernels = convex::dense_kernels();
    kernels.slacks(m, n, data.U.data(), data.x.data(), data.s.data(), slack.data());
    kernels.squares(m, n, data.U.data(), data.x.data(), square.data());
    const Vector x = data.x.head(n);
    CHECK((slack - (data.U * x - data.s)).norm() <= 1e-14 * slack.norm());
    CHECK((square - data.U.cwiseAbs2() * x).norm() <= 1e-14 * square.norm());
  }
}

TEST_CASE("a row that begins with 0 is found, wherever it stands") {
  for (Index n : {1, 2, 3, 4, 9})
    for (Index zero = 0; zero <= n + 11; ++zero) {
      RowMatrix U = draw(n, 3).U;
      if (zero < U.rows()) U(zero, 0) = 0;
      for (const DenseKernels* kernels : convex::all_dense_kernels())
        CHECK(kernels->first_entries_differ_from_zero(U.rows(), n, U.data()) == (zero == U.rows()));
    }
}

TEST_CASE("a dense factor times its transpose is the matrix, and solves with it are right to rounding") {
  for (Index n : {1, 3, 8, 13, 40, 75}) {
    const Data data = draw(n, 7);
    Matrix T = padded_matrix(data.A);
    const Index ld = padded(n);
    Vector inverse(16 * ld), x = data.x;
    const DenseKernels& kernels = convex::dense_kernels();
    kernels.factor(n, ld, T.data(), inverse.data());
    const Matrix L = T.topLeftCorner(n, n).triangularView<Eigen::Lower>();
    CHECK((L * L.transpose() - data.A).norm() <= 1e-15 * static_cast<double>(n) * data.A.norm());
    CHECK(T.topLeftCorner(n, n).isApprox(T.topLeftCorner(n, n).transpose(), 0));
    kernels.forward(n, ld, T.data(), inverse.data(), x.data());
    CHECK((L * x.head(n) - data.x.head(n)).norm() <= 1e-14 * L.norm() * x.norm());
    CHECK(x.tail(ld - n).isZero(0));
    const Vector y = x;
    kernels.backward(n, ld, T.data(), inverse.data(), x.data());
    CHECK((L.transpose() * x.head(n) - y.head(n)).norm() <= 1e-14 * L.norm() * x.norm());
    Matrix B(8, n);
    for (Index i = 0; i < n; ++i)
      for (Index k = 0; k < 8; ++k) B(k, i) = data.U(k % data.U.rows(), i);
    Matrix X = B;
    kernels.forward_pack(n, ld, T.data(), inverse.data(), X.data());
    CHECK((L * X.transpose() - B.transpose()).norm() <= 1e-14 * L.norm() * X.norm());
    const Matrix Y = X;
    kernels.backward_pack(n, ld, T.data(), inverse.data(), X.data());
    CHECK((L.transpose() * X.transpose() - Y.transpose()).norm() <= 1e-14 * L.norm() * X.norm());
  }
}

TEST_CASE("residuals in twice the working precision are the exact ones, rounded") {
  for (Index n : {1, 6, 8, 19}) {
    Data data = draw(n, 5);
    Vector z = Vector::Zero(padded(n)), lambda = data.s.head(static_cast<Index>(data.rows.size()));
    // Near a solution: what is left is far below the terms.
    z.head(n) = data.A * data.x.head(n);
    for (std::size_t k = 0; k < data.rows.size(); ++k)
      z.head(n) -= lambda[static_cast<Index>(k)] * data.U.row(data.rows[k]).transpose();
    Vector found(padded(n));
    convex::dense_kernels().stationarity(n, data.A.data(), data.x.data(), data.U.rows(), data.U.data(),
                                         static_cast<Index>(data.rows.size()), data.rows.data(),
                                         lambda.data(), z.data(), found.data());
    for (Index i = 0; i < n; ++i) {
      mpq_class exact(z[i]);
      for (std::size_t k = 0; k < data.rows.size(); ++k)
        exact += mpq_class(lambda[static_cast<Index>(k)]) * mpq_class(data.U(data.rows[k], i));
      for (Index j = 0; j < n; ++j) exact -= mpq_class(data.A(i, j)) * mpq_class(data.x[j]);
      const mpq_class difference = exact - mpq_class(found[i]);
      CHECK(std::abs(difference.get_d()) <= 1e-15 * std::abs(exact.get_d()) + 1e-29);
    }
  }
}

TEST_CASE("what the kernels say of sums, grids and finite numbers holds to the last entry") {
  for (const DenseKernels* kernels : convex::all_dense_kernels())
    for (Index n : {1, 5, 8, 9, 30, 64, 67}) {
      std::mt19937 generator(static_cast<unsigned>(n));
      std::uniform_int_distribution<int> whole(-8, 8);
      RowMatrix U(4, n);
      for (Index i = 0; i < U.size(); ++i) U.data()[i] = whole(generator) / 4.0;
      U.row(3) = (3 * U.row(0) - U.row(2)) / 2;
      const Index rows[] = {0, 2};
      const double coefficients[] = {3, -1}, shift = 0x1.8p50;  // whose neighbours are a quarter off
      const auto cancels = [&] { return kernels->cancels(n, U.data(), 3, 2, 2, rows, coefficients); };
      CHECK(cancels());
      for (Index i = 0; i < n; ++i) {
        const double entry = std::exchange(U(3, i), U(3, i) + 0x1p-30);
        CHECK_FALSE(cancels());
        U(3, i) = entry;
      }
      Vector x = 4 * U.row(0);
      CHECK(kernels->is_on_grid(n, x.data(), shift));
      CHECK(kernels->largest_size(n, x.data()) == x.cwiseAbs().maxCoeff());
      for (Index i = 0; i < n; ++i) {
        const double entry = std::exchange(x[i], 0.125);
        CHECK_FALSE(kernels->is_on_grid(n, x.data(), shift));
        x[i] = -33;
        CHECK(kernels->largest_size(n, x.data()) == 33);
        CHECK(kernels->is_finite(n, x.data()));
        for (const double wrong : {std::nan(""), -HUGE_VAL}) {
          x[i] = wrong;
          CHECK_FALSE(kernels->is_finite(n, x.data()));
        }
        x[i] = entry;
      }
    }
}

TEST_CASE("a matrix is its own transpose when no entry is one bit off and all are finite") {
  for (const DenseKernels* kernels : convex::all_dense_kernels())
    for (Index n : {3, 8, 19}) {
      const Matrix A = draw(n, 3).A;
      Matrix W = (A + A.transpose()) / 2, T(padded(n), padded(n));
      const auto is_symmetric = [&] { return kernels->take_symmetric(n, padded(n), W.data(), T.data()); };
      CHECK(is_symmetric());
      CHECK(T == padded_matrix(W));
      for (Index i = 0; i < n * n; ++i) {
        double& entry = W(i % n, i / n);
        const double before = entry;
        entry = std::nextafter(before, HUGE_VAL);
        CHECK(is_symmetric() == (i % n == i / n));
        for (const double wrong : {std::nan(""), -HUGE_VAL}) {
          entry = W(i / n, i % n) = wrong;
          CHECK_FALSE(is_symmetric());
        }
        entry = W(i / n, i % n) = before;
      }
    }
}

TEST_CASE("columns added at once are the columns added one after the other, to the last bit") {
  for (const DenseKernels* kernels : convex::all_dense_kernels())
    for (Index n : {8, 24, 64, 136}) {
      const Data data = draw(n, 3);
      const Index columns[] = {0, 3, 4, 7};
      Vector y = data.A.col(1), expected = y;
      for (Index c : columns) kernels->add_multiple(n, data.x[c], data.A.data() + c * n, expected.data());
      kernels->add_columns(n, 4, columns, data.x.data(), data.A.data(), n, y.data());
      CHECK(y == expected);
    }
}
