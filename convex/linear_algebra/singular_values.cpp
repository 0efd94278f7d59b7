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

/// scale · unit = Z, whose squares are ordinary doubles, and the rotation that takes its columns nearly to
/// right angles.
struct Turned {
  explicit Turned(const Matrix& Z) {
    const double largest = Z.cwiseAbs().maxCoeff();
    scale = largest > 0 && std::isfinite(largest) ? std::exp2(std::ilogb(largest)) : 1;
    unit = Z / scale;
    const SymmetricEigen eigen(unit.transpose() * unit);
    turn = eigen.found ? Matrix(eigen.vectors.rowwise().reverse()) : Matrix::Identity(Z.cols(), Z.cols());
  }

  double scale;
  Matrix unit, turn;
};

/// Z or its transpose, whichever has no more columns than rows.
Matrix made_tall(const Matrix& Z) { return Z.cols() > Z.rows() ? Matrix(Z.transpose()) : Z; }

}  // namespace

SingularValues::SingularValues(const Matrix& Z) : U(Z.rows(), 0), V(Z.cols(), 0), sigma(0) {
  if (Z.size() == 0) return;
  const Matrix tall = made_tall(Z);
  const Index n = tall.cols();
  if (n < large_matrix) {
    const Eigen::JacobiSVD<Matrix> svd(tall, thin);
    U = svd.matrixU();
    V = svd.matrixV();
    sigma = svd.singularValues();
  } else {
    const Turned turned(tall);
    const Householder factor(turned.unit * turned.turn);
    const Eigen::JacobiSVD<Matrix> svd(factor.R(), thin);
    U = factor.Q(n) * svd.matrixU();
    V = turned.turn * svd.matrixV();
    sigma = turned.scale * svd.singularValues();
  }
  if (Z.cols() > Z.rows()) U.swap(V);
}

Vector singular_values(const Matrix& Z) {
  if (Z.size() == 0) return Vector(0);
  const Matrix tall = made_tall(Z);
  if (tall.cols() < large_matrix) return Eigen::JacobiSVD<Matrix>(tall).singularValues();
  const Turned turned(tall);
  return turned.scale * Eigen::JacobiSVD<Matrix>(Householder(turned.unit * turned.turn).R()).singularValues();
}

}  // namespace convex::linear_algebra
