#include "convex/linear_algebra/complex_eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace convex::linear_algebra {

std::vector<std::complex<double>> complex_eigenvalues(const Matrix& M) {
  const Eigen::EigenSolver<Matrix> solver(M, false);
  std::vector<std::complex<double>> found(solver.eigenvalues().begin(), solver.eigenvalues().end());
  std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) {
    const double a = std::abs(x), b = std::abs(y);
    constexpr double same = 1e-12;
    if (std::abs(a - b) > same * std::max(a, b)) return a > b;
    return x.imag() != y.imag() ? x.imag() > y.imag() : x.real() > y.real();
  });
  return found;
}

}  // namespace convex::linear_algebra
