#pragma once

#include <complex>
#include <vector>

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// The eigenvalues of a square matrix, the largest first; of a conjugate pair the one with positive imaginary
/// part first. They are those of the blocks of its real Schur form (Eigen's RealSchur).
std::vector<std::complex<double>> complex_eigenvalues(const Matrix& M);

}  // namespace convex::linear_algebra
