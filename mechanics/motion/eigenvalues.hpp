#pragma once

#include <complex>
#include <vector>

#include "convex/vector.hpp"

namespace mechanics {

/// The eigenvalues of a square matrix, the largest first; of a conjugate pair the one with positive imaginary
/// part first.
std::vector<std::complex<double>> eigenvalues(const convex::Matrix& M);

/// x with M x = y by complete pivoting, the least one where M is singular.
convex::Vector solved(const convex::Matrix& M, const convex::Vector& y);

}  // namespace mechanics
