#pragma once

#include <complex>
#include <vector>

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// The eigenvalues of a square matrix (Eigen's EigenSolver), the largest first; of a conjugate pair the one
/// with positive imaginary part first.
std::vector<std::complex<double>> complex_eigenvalues(const Matrix& M);

}  // namespace convex::linear_algebra
