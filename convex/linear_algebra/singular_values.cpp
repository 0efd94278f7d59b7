#include "convex/linear_algebra/singular_values.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "convex/linear_algebra/householder.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"

namespace convex::linear_algebra {
namespace {

/// From this size on matrices are turned by eigenvectors of ZᵀZ first. Their columns are then nearly at right
/// angles, so that rotations, which give the digits, have little left to do.
constexpr Index large_matrix = 48;

constexpr int thin = Eigen::ComputeThinU | Eigen::ComputeThinV;

}  // namespace

SingularValues::SingularValues(const Matrix& Z) : U(Z.rows(), 0), V(Z.cols(), 0), sigma(0) {
  if (Z.size() == 0) return;
  const bool is_wide = Z.cols() > Z.rows();
  const Matrix tall = is_wide ? Matrix(Z.transpose()) : Z;
  const Index n = tall.cols();
  if (n < large_matrix) {
    const Eigen::JacobiSVD<Matrix> svd(tall, thin);
    U = svd.matrixU();
    V = svd.matrixV();
    sigma = svd.singularValues();
  } else {
    const double largest = tall.cwiseAbs().maxCoeff();
    const double scale = largest > 0 && std::isfinite(largest) ? std::exp2(std::ilogb(largest)) : 1;
    const Matrix unit = tall / scale;  // squares are ordinary doubles
    const SymmetricEigen eigen(unit.transpose() * unit);
    const Matrix turn = eigen.found ? Matrix(eigen.vectors.rowwise().reverse()) : Matrix::Identity(n, n);
    const Householder factor(unit * turn);
    const Eigen::JacobiSVD<Matrix> svd(factor.R(), thin);
    U = factor.Q(n) * svd.matrixU();
    V = turn * svd.matrixV();
    sigma = scale * svd.singularValues();
  }
  if (is_wide) U.swap(V);
}

Vector singular_values_by_rotations(const Matrix& Z) { return Eigen::JacobiSVD<Matrix>(Z).singularValues(); }

Vector singular_values(const Matrix& Z) { return SingularValues(Z).sigma; }

}  // namespace convex::linear_algebra
