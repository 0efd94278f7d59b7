#include "mechanics/motion/inertia_factor.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics {
namespace {

/// A pivot is rounded about so many times, for each coordinate.
constexpr double roundings_of_pivot = 8;

}  // namespace

bool InertiaFactor::make(const convex::Matrix& A) {
  n_ = A.rows();
  const auto n = static_cast<std::size_t>(n_);
  L_.resize(n * n);
  inverse_.resize(n);
  is_made_ = false;
  for (std::size_t i = 0; i < n; ++i) {
    double* row = L_.data() + i * n;
    for (std::size_t j = 0; j <= i; ++j) {
      const double* other = L_.data() + j * n;
      double sum = A(static_cast<Index>(i), static_cast<Index>(j));
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      if (j < i) {
        row[j] = sum * inverse_[j];
        continue;
      }
      const double diagonal = A(static_cast<Index>(i), static_cast<Index>(i));
      if (!(sum > roundings_of_pivot * static_cast<double>(n) * convex::unit_roundoff * diagonal))
        return false;
      row[i] = std::sqrt(sum);
      inverse_[i] = 1 / row[i];
    }
  }
  is_made_ = true;
  return true;
}

void InertiaFactor::solve(Vector& x) const {
  const auto n = static_cast<std::size_t>(n_);
  double* y = x.data();
  for (std::size_t i = 0; i < n; ++i) {
    double sum = y[i];
    for (std::size_t k = 0; k < i; ++k) sum -= L_[i * n + k] * y[k];
    y[i] = sum * inverse_[i];
  }
  for (std::size_t i = n; i-- > 0;) {
    y[i] *= inverse_[i];
    for (std::size_t k = 0; k < i; ++k) y[k] -= L_[i * n + k] * y[i];
  }
}

double InertiaFactor::norm(std::span<const double> x) const {
  const auto n = static_cast<std::size_t>(n_);
  double most = 0;  // of the entries: their squares may be too large for doubles
  for (const double entry : x) most = std::max(most, std::abs(entry));
  if (!(most > 0) || !std::isfinite(most)) return most;
  double sum = 0;
  for (std::size_t j = 0; j < n; ++j) {
    double entry = 0;
    for (std::size_t i = j; i < n; ++i) entry += L_[i * n + j] * (x[i] / most);
    sum += entry * entry;
  }
  return most * std::sqrt(sum);
}

}  // namespace mechanics
