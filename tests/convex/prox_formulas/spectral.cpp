#include "convex/prox_formulas/spectral.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <random>

#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/norm2.hpp"
#include "convex/prox_formulas/nuclear_norm.hpp"

using convex::Index;
using convex::Matrix;
using convex::Vector;
namespace k = convex::prox_formulas;

namespace {

Matrix gaussian(Index rows, Index cols, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Matrix M(rows, cols);
  for (Index i = 0; i < M.size(); ++i) M.data()[i] = normal(generator);
  return M;
}

Matrix unstacked(const Vector& z, Index n) { return Eigen::Map<const Matrix>(z.data(), n, n); }

/// Whether S + slack I has a Cholesky factor in 64 digits: no eigenvalue below -slack.
bool is_psd(const Matrix& S, double slack) {
  using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const LongMatrix lifted = S.cast<long double>() + slack * LongMatrix::Identity(S.rows(), S.cols());
  return Eigen::LLT<LongMatrix>(lifted).info() == Eigen::Success;
}

constexpr double few = 30 * convex::unit_roundoff;

std::vector<Matrix> samples() {
  std::mt19937 generator(12);
  std::vector<Matrix> found;
  for (Index n : {1, 2, 3, 5, 8, 20}) {
    const Matrix B = gaussian(n, n, generator), S = B + B.transpose();
    const Matrix Q = Eigen::HouseholderQR<Matrix>(B).householderQ();
    found.insert(found.end(), {B, S, B * B.transpose(), -B * B.transpose(), Matrix::Zero(n, n),
                               Matrix::Identity(n, n), B.col(0) * B.col(0).transpose(),
                               // one repeated eigenvalue of either sign
                               Q * Vector::LinSpaced(n, -1, 1).cwiseSign().asDiagonal() * Q.transpose(),
                               B * 0x1p500, B * 0x1p-500, B - B.transpose()});
  }
  return found;
}

}  // namespace

TEST_CASE("a matrix, symmetric or not, is the sum of orthogonal ones in the psd cone and in its polar") {
  for (const Matrix& Z : samples()) {
    const Index n = Z.rows();
    const Vector z = Eigen::Map<const Vector>(Z.data(), n * n);
    const Matrix X = unstacked(k::proj_psd_cone(z), n), Y = unstacked(k::proj_psd_polar(z), n);
    const double size = k::length(z), slack = few * size + 1e-300;
    CAPTURE(Z);
    CHECK(X == X.transpose());
    CHECK(is_psd(X, slack));
    CHECK(is_psd(-(Y + Y.transpose()), 2 * slack));
    const Matrix symmetric = 0.5 * Z + 0.5 * Z.transpose();
    CHECK(is_psd(X - symmetric, 2 * slack));
    CHECK(k::length(Eigen::Map<const Vector>((X + Y - Z).eval().data(), n * n)) <= slack);
    CHECK(std::abs((X / (size + 1e-300)).cwiseProduct(Y).sum()) <= slack);
  }
}

TEST_CASE("a positive semidefinite matrix stays as it is, to the last digit where it is definite") {
  Matrix Z(3, 3);
  Z << 4, 1, 0, 1, 3, 1, 0, 1, 2;
  CHECK(k::psd_projection(Z).X == Z);
  CHECK((k::psd_projection(-Z).X - Matrix::Zero(3, 3)).norm() == 0);
  const Vector none(0);
  CHECK(k::proj_psd_cone(none).size() == 0);
  CHECK(k::proj_psd_polar(none).size() == 0);
  CHECK(k::prox_log_det(none).size() == 0);
}

TEST_CASE("the prox of -log det solves X - weight X^-1 = Z on symmetric matrices") {
  for (const Matrix& Z : samples())
    for (double weight : {0.25, 3.0}) {
      if (Z.norm() > 1e100) continue;  // X^-1 leaves no trace there
      const Matrix X = k::log_det_prox(Z, weight).X, symmetric = 0.5 * Z + 0.5 * Z.transpose();
      CHECK(is_psd(X, 0));
      // X² - Z X = weight I in symmetric form, without an inverse.
      const Matrix rest =
          X * X - 0.5 * (symmetric * X + X * symmetric) - weight * Matrix::Identity(Z.rows(), Z.cols());
      CHECK(rest.norm() <= few * (X.norm() * (X.norm() + Z.norm()) + weight));
    }
  CHECK_THROWS_AS(k::log_det_prox(Matrix::Identity(2, 2), 0), convex::InvalidInput);
}

TEST_CASE("the prox of the nuclear norm leaves a subgradient: norm at most weight, and attained at X") {
  std::mt19937 generator(3);
  for (const auto& [rows, cols] :
       std::vector<std::pair<Index, Index>>{{1, 1}, {1, 5}, {4, 2}, {3, 3}, {6, 7}, {60, 50}})
    for (double weight : {0.0, 0.5, 2.0, 100.0})
      for (int rank = 0; rank < 3; ++rank) {
        const Matrix Z = rank == 0
                             ? gaussian(rows, cols, generator)
                             : Matrix(gaussian(rows, rank, generator) * gaussian(rank, cols, generator));
        const Matrix X = k::nuclear_norm_prox(Z, weight).X, Y = Z - X;
        const Matrix ball = k::proj_spectral_ball(Z, weight);
        const double size = Z.norm() + weight, slack = few * size * std::sqrt(static_cast<double>(rows));
        CHECK((X + ball - Z).norm() <= slack);
        // YᵀY <= weight² I, and Y is weight times the polar factor on the range of X: XᵀY is psd and
        // (XᵀY)² = weight² XᵀX.
        const Matrix YtY = Y.transpose() * Y, XtY = X.transpose() * Y;
        const Matrix room = weight * weight * Matrix::Identity(cols, cols) - YtY;
        CHECK(is_psd(room, slack * size));
        CHECK((XtY - XtY.transpose()).norm() <= slack * size);
        CHECK(is_psd(0.5 * (XtY + XtY.transpose()), slack * size));
        CHECK((XtY * XtY - weight * weight * X.transpose() * X).norm() <= slack * size * size * size);
      }
  CHECK_THROWS_AS(k::nuclear_norm_prox(Matrix::Ones(2, 2), -1), convex::InvalidInput);
  CHECK_THROWS_AS(k::prox_nuclear_norm(Vector::Ones(5), 1, 2), convex::InvalidInput);
}

TEST_CASE("a derivative applied to a matrix is the one applied to it stacked") {
  std::mt19937 generator(8);
  const Matrix Z = gaussian(4, 4, generator), H = gaussian(4, 4, generator);
  const auto stacked = [](const Matrix& M) { return Vector(Eigen::Map<const Vector>(M.data(), M.size())); };
  for (const k::SpectralProx& prox : {k::psd_projection(Z), k::log_det_prox(Z, 2)})
    CHECK((prox.jacobian() * stacked(H) - stacked(prox.derivative(H))).norm() <= 1e-13);
  const k::NuclearNormProx prox = k::nuclear_norm_prox(Z, 1);
  CHECK((prox.jacobian() * stacked(H) - stacked(prox.derivative(H))).norm() <= 1e-13);
}

TEST_CASE("a vector that stacks no square matrix is refused") {
  CHECK_THROWS_AS(k::proj_psd_cone(Vector::Ones(5)), convex::InvalidInput);
  CHECK_THROWS_AS(k::psd_projection(Matrix::Ones(2, 3)), convex::InvalidInput);
}
