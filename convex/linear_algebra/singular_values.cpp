#include "convex/linear_algebra/singular_values.hpp"

#include <Eigen/SVD>

namespace convex::linear_algebra {
namespace {

/// From this size on divide and conquer is faster than rotations by more than it costs in digits.
constexpr Index large_matrix = 48;

constexpr int thin = Eigen::ComputeThinU | Eigen::ComputeThinV;

}  // namespace

SingularValues::SingularValues(const Matrix& Z) : U(Z.rows(), 0), V(Z.cols(), 0), sigma(0) {
  if (Z.size() == 0) return;
  const auto keep = [&](const auto& svd) {
    U = svd.matrixU();
    V = svd.matrixV();
    sigma = svd.singularValues();
  };
  if (std::min(Z.rows(), Z.cols()) < large_matrix)
    keep(Eigen::JacobiSVD<Matrix>(Z, thin));
  else
    keep(Eigen::BDCSVD<Matrix>(Z, thin));
}

Vector singular_values_by_rotations(const Matrix& Z) { return Eigen::JacobiSVD<Matrix>(Z).singularValues(); }

Vector singular_values(const Matrix& Z) { return Eigen::BDCSVD<Matrix>(Z).singularValues(); }

}  // namespace convex::linear_algebra
