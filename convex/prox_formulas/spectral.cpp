#include "convex/prox_formulas/spectral.hpp"

#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"

namespace convex::prox_formulas {

namespace {

Matrix symmetric_part(const Matrix& Z) {
  if (Z.rows() != Z.cols())
    throw InvalidInput("psd_cone: the matrix is " + std::to_string(Z.rows()) + "x" +
                       std::to_string(Z.cols()) + "; give a square one");
  return 0.5 * Z + 0.5 * Z.transpose();
}

linear_algebra::SymmetricEigen decomposed(const Matrix& S) {
  linear_algebra::SymmetricEigen eigen(S);
  invariant(eigen.found, "the eigenvalues of a finite symmetric matrix are found");
  return eigen;
}

/// V diag(w) Vᵀ over the columns with w != 0 of sign `side`, exactly symmetric.
Matrix composed(const Matrix& V, const Vector& w, double side) {
  const Index n = V.rows();
  Matrix half(n, n);
  Index rank = 0;
  for (Index k = 0; k < n; ++k)
    if (side * w[k] > 0) half.col(rank++) = std::sqrt(side * w[k]) * V.col(k);
  Matrix X = Matrix::Zero(n, n);
  X.selfadjointView<Eigen::Lower>().rankUpdate(half.leftCols(rank), side);
  X.triangularView<Eigen::StrictlyUpper>() = X.transpose();
  return X;
}

Matrix unstacked(const Vector& z) {
  const Index n = order_of_stacked(z);
  return Eigen::Map<const Matrix>(z.data(), n, n);
}

Vector stacked(const Matrix& X) { return Eigen::Map<const Vector>(X.data(), X.size()); }

}  // namespace

Index order_of_stacked(const Vector& z) {
  const auto n = static_cast<Index>(std::lround(std::sqrt(static_cast<double>(z.size()))));
  if (n * n != z.size())
    throw InvalidInput("psd_cone: a vector of " + counted(z.size(), "entry", "entries") +
                       " stacks no square matrix; give n*n entries");
  return n;
}

Matrix SpectralProx::derivative(const Matrix& H) const {
  const Matrix symmetric = 0.5 * H + 0.5 * H.transpose();
  return V * divided.cwiseProduct(V.transpose() * symmetric * V) * V.transpose();
}

Matrix SpectralProx::jacobian() const {
  const Index n = V.rows();
  Matrix J = Matrix::Zero(n * n, n * n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j <= i; ++j) {
      const Matrix pair = 0.5 * (V.col(i) * V.col(j).transpose() + V.col(j) * V.col(i).transpose());
      const Vector e = stacked(pair);
      J += (i == j ? divided(i, j) : 2 * divided(i, j)) * e * e.transpose();
    }
  return J;
}

SpectralProx psd_projection(const Matrix& Z) {
  const Matrix S = symmetric_part(Z);
  const Index n = S.rows();
  if (n == 0) return {S, S, Vector(0), S};
  const auto eigen = decomposed(S);
  const Vector& lambda = eigen.values;
  SpectralProx prox{S, eigen.vectors, lambda, Matrix(n, n)};
  if (lambda[0] < 0) prox.X = composed(prox.V, lambda, 1);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double high = std::max(lambda[i], lambda[j]), low = std::min(lambda[i], lambda[j]);
      prox.divided(i, j) = low >= 0 ? 1 : high <= 0 ? 0 : high / (high - low);
    }
  return prox;
}

SpectralProx log_det_prox(const Matrix& Z, double weight) {
  if (!(weight > 0 && std::isfinite(weight)))
    throw InvalidInput("log_det: the weight is " + std::to_string(weight) + "; give a positive number");
  const Matrix S = symmetric_part(Z);
  const Index n = S.rows();
  if (n == 0) return {S, S, Vector(0), S};
  const auto eigen = decomposed(S);
  const Vector& lambda = eigen.values;
  SpectralProx prox{Matrix(), eigen.vectors, lambda, Matrix(n, n)};
  const double h = 2 * std::sqrt(weight);
  const Vector root = lambda.unaryExpr([h](double v) { return std::hypot(v, h); });
  Vector phi(n);
  for (Index i = 0; i < n; ++i)
    phi[i] = lambda[i] > 0 ? lambda[i] / 2 + root[i] / 2 : h / 2 * (h / (root[i] - lambda[i]));
  prox.X = composed(prox.V, phi, 1);
  // Divided by lambda_i - lambda_j by hand: (root_i + root_j) times it is the difference of the squares.
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) prox.divided(i, j) = (phi[i] + phi[j]) / (root[i] + root[j]);
  return prox;
}

Vector proj_psd_cone(const Vector& z) { return stacked(psd_projection(unstacked(z)).X); }

Vector prox_log_det(const Vector& z, double weight) { return stacked(log_det_prox(unstacked(z), weight).X); }

Vector proj_psd_polar(const Vector& z) {
  const Matrix Z = unstacked(z), S = symmetric_part(Z), skew = 0.5 * Z - 0.5 * Z.transpose();
  if (S.size() == 0) return z;
  const auto eigen = decomposed(S);
  if (eigen.values.maxCoeff() <= 0) return z;
  return stacked(skew + composed(eigen.vectors, eigen.values, -1));
}

}  // namespace convex::prox_formulas
