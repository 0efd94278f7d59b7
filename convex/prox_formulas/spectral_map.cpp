#include "convex/prox_formulas/spectral_map.hpp"

#include <cmath>

#include "convex/invariant.hpp"
#include "convex/linear_algebra/singular_values.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"

namespace convex::prox_formulas {
namespace {

using linear_algebra::SingularValues;
using linear_algebra::SymmetricEigen;

/// Values nearer to each other than this part of them have the derivative in place of the quotient, which
/// would be rounding: each is then off by as much.
constexpr double nearly_equal = 1e-8;

/// (phi_i - phi_j)/(s_i - s_j), or what it tends to as the two meet.
double quotient(const Vector& s, const Vector& phi, const Matrix& J, Index i, Index j) {
  const double apart = s[i] - s[j];
  if (std::abs(apart) > nearly_equal * (std::abs(s[i]) + std::abs(s[j]))) return (phi[i] - phi[j]) / apart;
  return J(i, i) - J(i, j);
}

SymmetricEigen eigen_of_symmetric_part(const Matrix& Z) {
  SymmetricEigen eigen(0.5 * Z + 0.5 * Z.transpose());
  invariant(eigen.found, "the eigenvalues of a finite symmetric matrix are found");
  return eigen;
}

/// The columns of a linear map of matrices, made symmetric.
Matrix stacked_map(Index rows, Index columns, const std::function<Matrix(const Matrix&)>& map) {
  const Index size = rows * columns;
  Matrix J(size, size);
  for (Index k = 0; k < size; ++k) {
    Matrix H = Matrix::Zero(rows, columns);
    H.data()[k] = 1;
    J.col(k) = map(H).reshaped();
  }
  return 0.5 * J + 0.5 * J.transpose();
}

}  // namespace

Matrix map_of_singular_values(const Matrix& Z, const VectorMap& phi) {
  const SingularValues s(Z);
  return s.U * phi(s.sigma).asDiagonal() * s.V.transpose();
}

Matrix jacobian_of_singular_values(const Matrix& Z, const VectorMap& phi, const VectorJacobian& J_phi) {
  const SingularValues s(Z);
  const Index k = s.sigma.size();
  const Vector values = phi(s.sigma);
  const Matrix J = J_phi(s.sigma);
  Vector ratio(k);
  for (Index i = 0; i < k; ++i) ratio[i] = s.sigma[i] > 0 ? values[i] / s.sigma[i] : J(i, i);
  return stacked_map(Z.rows(), Z.cols(), [&](const Matrix& H) -> Matrix {
    const Matrix M = s.U.transpose() * H * s.V;
    Matrix inner = (J * M.diagonal()).asDiagonal();
    for (Index i = 0; i < k; ++i)
      for (Index j = 0; j < k; ++j) {
        if (i == j) continue;
        const double sum = s.sigma[i] + s.sigma[j], mean = sum > 0 ? (values[i] + values[j]) / sum : ratio[i];
        inner(i, j) =
            quotient(s.sigma, values, J, i, j) * (M(i, j) + M(j, i)) / 2 + mean * (M(i, j) - M(j, i)) / 2;
      }
    const Matrix HV = H * s.V, UH = s.U.transpose() * H;
    return s.U * inner * s.V.transpose() + (HV - s.U * M) * ratio.asDiagonal() * s.V.transpose() +
           s.U * ratio.asDiagonal() * (UH - M * s.V.transpose());
  });
}

Matrix map_of_eigenvalues(const Matrix& Z, const VectorMap& phi) {
  const SymmetricEigen s = eigen_of_symmetric_part(Z);
  const Matrix X = s.vectors * phi(s.values).asDiagonal() * s.vectors.transpose();
  return 0.5 * X + 0.5 * X.transpose();
}

Matrix jacobian_of_eigenvalues(const Matrix& Z, const VectorMap& phi, const VectorJacobian& J_phi) {
  const SymmetricEigen s = eigen_of_symmetric_part(Z);
  const Vector values = phi(s.values);
  const Matrix J = J_phi(s.values);
  return stacked_map(Z.rows(), Z.cols(), [&](const Matrix& H) -> Matrix {
    const Matrix M = s.vectors.transpose() * (0.5 * H + 0.5 * H.transpose()) * s.vectors;
    Matrix inner = (J * M.diagonal()).asDiagonal();
    for (Index i = 0; i < M.rows(); ++i)
      for (Index j = 0; j < M.cols(); ++j)
        if (i != j) inner(i, j) = quotient(s.values, values, J, i, j) * M(i, j);
    return s.vectors * inner * s.vectors.transpose();
  });
}

}  // namespace convex::prox_formulas
