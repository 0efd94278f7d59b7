#include "convex/linear_algebra/complex_eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace convex::linear_algebra {

std::vector<std::complex<double>> complex_eigenvalues(const Matrix& M) {
  const Eigen::RealSchur<Matrix> schur(M, false);
  const Matrix& T = schur.matrixT();
  const Index n = T.rows();
  std::vector<std::complex<double>> found;
  for (Index i = 0; i < n; ++i) {
    if (i + 1 == n || T(i + 1, i) == 0) {
      found.emplace_back(T(i, i));
      continue;
    }
    // Eigen leaves a block of two only where its eigenvalues are no real numbers.
    const double p = 0.5 * (T(i, i) - T(i + 1, i + 1));
    const double largest = std::max({std::abs(p), std::abs(T(i + 1, i)), std::abs(T(i, i + 1))});
    const double z = largest * std::sqrt(std::abs((p / largest) * (p / largest) +
                                                  (T(i + 1, i) / largest) * (T(i, i + 1) / largest)));
    for (double imaginary : {z, -z}) found.emplace_back(T(i + 1, i + 1) + p, imaginary);
    ++i;
  }
  std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) {
    const double a = std::abs(x), b = std::abs(y);
    constexpr double same = 1e-12;
    if (std::abs(a - b) > same * std::max(a, b)) return a > b;
    return x.imag() != y.imag() ? x.imag() > y.imag() : x.real() > y.real();
  });
  return found;
}

}  // namespace convex::linear_algebra
