#include "convex/linear_algebra/inverse.hpp"

#include <Eigen/LU>

namespace convex::linear_algebra {

Matrix inverse(const Matrix& A) { return Eigen::PartialPivLU<Matrix>(A).inverse(); }

}  // namespace convex::linear_algebra
