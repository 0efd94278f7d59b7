#include "mechanics/motion/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>

namespace mechanics {

std::vector<std::complex<double>> eigenvalues(const convex::Matrix& M) {
  const Eigen::EigenSolver<convex::Matrix> solver(M, false);
  std::vector<std::complex<double>> found(solver.eigenvalues().begin(), solver.eigenvalues().end());
  std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) {
    const double a = std::abs(x), b = std::abs(y);
    constexpr double same = 1e-12;
    if (std::abs(a - b) > same * std::max(a, b)) return a > b;
    return x.imag() != y.imag() ? x.imag() > y.imag() : x.real() > y.real();
  });
  return found;
}

convex::Vector solved(const convex::Matrix& M, const convex::Vector& y) {
  return Eigen::CompleteOrthogonalDecomposition<convex::Matrix>(M).solve(y);
}

}  // namespace mechanics
