#include "convex/exact/grid_sum.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace convex::inline exact_arithmetic {
namespace {

/// Doubles hold all multiples of a number up to so many times it.
constexpr double whole = 0x1p52;

/// A point with more steps leaves too few for the rows.
constexpr double most_steps = 0x1p44;

/// k, where 2ᵏ is the largest power of 2 that x, not 0 and not subnormal, is a multiple of.
int lowest_bit(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int exponent = static_cast<int>((bits >> 52) & 0x7ff) - 1075;
  return exponent + std::countr_zero(bits | (std::uint64_t{1} << 52));
}

/// The power of 2 no less than x > 0.
double power_above(double x) { return std::ldexp(1, std::ilogb(x) + 1); }

bool is_multiple(double x, double step) {
  const double shift = 1.5 * whole * step;
  return std::abs(x) <= whole * step && (x + shift) - shift == x;
}

}  // namespace

GridSum::GridSum(const Eigen::Ref<const Vector>& q) : q_(q.data()), n_(q.size()) {
  int lowest = std::numeric_limits<int>::max();
  double largest = 0;
  for (const double x : q) {
    if (x == 0) continue;
    if (!std::isnormal(x)) return;
    lowest = std::min(lowest, lowest_bit(x));
    largest = std::max(largest, std::abs(x));
  }
  is_zero_ = largest == 0;
  if (is_zero_) return;
  const double step = std::ldexp(1, lowest);
  const double steps = static_cast<double>(q.size()) * largest / step;
  if (!(steps <= most_steps) || !std::isnormal(step)) return;
  step_ = step;
  steps_ = std::max(1.0, steps);
}

std::optional<double> GridSum::value(const double* u, double s) const {
  if (is_zero_) return -s;
  if (step_ == 0) return std::nullopt;
  const Index n = n_;
  double largest = 0;
  for (Index i = 0; i < n; ++i) largest = std::max(largest, std::abs(u[i]));
  if (largest == 0) return -s;
  // The finest grid on which the sum has no more than `whole` steps.
  const double step = power_above(largest * steps_ / whole);
  const double shift = 1.5 * whole * step;
  if (!std::isnormal(step) || !std::isnormal(step * step_) || !std::isfinite(shift) ||
      !is_multiple(s, step * step_))
    return std::nullopt;
  double sum = 0, off = 0;
  for (Index i = 0; i < n; ++i) {
    off += std::abs((u[i] + shift) - shift - u[i]);
    sum += u[i] * q_[i];
  }
  return off == 0 ? std::optional(sum - s) : std::nullopt;
}

}  // namespace convex::inline exact_arithmetic
