#include "mechanics/motion/inertia_factor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "convex/processor.hpp"
#include "mechanics/motion/eight.hpp"

namespace mechanics::inline motions {
namespace {

/// A pivot is rounded about so many times, for each coordinate.
constexpr double roundings_of_pivot = 8;

/// x becomes A⁻¹x. count: the number of coordinates, as a constant if it is known.
template <class Count>
void solve_factored(Count count, const double* M, const double* inverse, double* x) {
  const std::size_t n = count;
  for (std::size_t i = 1; i < n; ++i)
    for (std::size_t k = 0; k < i; ++k) x[i] -= M[i * n + k] * x[k];
  for (std::size_t i = 0; i < n; ++i) x[i] *= inverse[i];
  for (std::size_t i = n; i-- > 1;)
    for (std::size_t k = 0; k < i; ++k) x[k] -= M[i * n + k] * x[i];
}

template <std::size_t n>
using Fixed = std::integral_constant<std::size_t, n>;

/// Squares may be too large for doubles, so that the largest entry is divided by first. Eight at a time.
MOREAU_CLONES void norms_by(const double* M, const double* root, std::size_t n, const double* const* x,
                            double* of, std::size_t count) {
  for (std::size_t first = 0; first < count; first += Eight::count) {
    Wide most{}, squares{}, entry, other;
    const auto get = [&](std::size_t i, Wide& to) { std::memcpy(&to, x[i] + first, sizeof(Wide)); };
    for (std::size_t i = 0; i < n; ++i) {
      get(i, entry);
      entry = entry < 0 ? -entry : entry;
      most = most < entry ? entry : most;
    }
    const Wide is_normal = most >= std::numeric_limits<double>::min() ? Wide{} + 1 : Wide{};
    const Wide scale = is_normal / (is_normal > 0 ? most : Wide{} + 1);
    for (std::size_t j = 0; j < n; ++j) {
      get(j, entry);
      for (std::size_t i = j + 1; i < n; ++i) {
        get(i, other);
        entry += M[i * n + j] * other;
      }
      const Wide part = root[j] * (entry * scale);
      squares += part * part;
    }
    Eight norm;
    std::memcpy(norm.of, &squares, sizeof norm);
    for (double& each : norm.of) each = std::sqrt(each);
    std::memcpy(&squares, norm.of, sizeof norm);
    most *= squares;
    std::memcpy(of + first, &most, sizeof most);
  }
}

}  // namespace

bool InertiaFactor::make(const convex::Matrix& A) {
  n_ = A.rows();
  const auto n = static_cast<std::size_t>(n_);
  M_.resize(n * n);
  root_.resize(n);
  inverse_.resize(n);
  is_made_ = false;
  for (std::size_t i = 0; i < n; ++i) {
    double* row = M_.data() + i * n;
    double pivot = A(static_cast<Index>(i), static_cast<Index>(i));
    for (std::size_t j = 0; j < i; ++j) {  // first M_ij D_j
      const double* other = M_.data() + j * n;
      double sum = A(static_cast<Index>(i), static_cast<Index>(j));
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      row[j] = sum;
    }
    const double diagonal = pivot;
    for (std::size_t j = 0; j < i; ++j) {
      const double entry = row[j];
      row[j] *= inverse_[j];
      pivot -= entry * row[j];
    }
    if (!(pivot > roundings_of_pivot * static_cast<double>(n) * convex::unit_roundoff * diagonal))
      return false;
    root_[i] = std::sqrt(pivot);
    inverse_[i] = 1 / pivot;
    if (!std::isnormal(inverse_[i])) return false;
  }
  is_made_ = true;
  return true;
}

void InertiaFactor::solve(double* x) const {
  const auto with = [&](auto count) { solve_factored(count, M_.data(), inverse_.data(), x); };
  switch (n_) {
    case 1:
      return with(Fixed<1>());
    case 2:
      return with(Fixed<2>());
    case 3:
      return with(Fixed<3>());
    default:
      return with(static_cast<std::size_t>(n_));
  }
}

double InertiaFactor::norm(std::span<const double> x) const {
  const auto n = static_cast<std::size_t>(n_);
  double most = 0;  // of the entries: their squares may be too large for doubles
  for (const double entry : x) most = std::max(most, std::abs(entry));
  if (!(most > 0) || !std::isfinite(most)) return most;
  double sum = 0;
  for (std::size_t j = 0; j < n; ++j) {
    double entry = x[j] / most;
    for (std::size_t i = j + 1; i < n; ++i) entry += M_[i * n + j] * (x[i] / most);
    entry *= root_[j];
    sum += entry * entry;
  }
  return most * std::sqrt(sum);
}

void InertiaFactor::norms(const double* const* x, double* of, std::size_t count) const {
  norms_by(M_.data(), root_.data(), static_cast<std::size_t>(n_), x, of, count);
}

}  // namespace mechanics::inline motions
