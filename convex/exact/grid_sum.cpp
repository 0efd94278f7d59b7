#include "convex/exact/grid_sum.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "convex/dense/dense_kernels.hpp"

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

/// The power of 2 above x > 0; 0 for subnormal x.
double power_above(double x) {
  const auto exponent = std::bit_cast<std::uint64_t>(x) >> 52;
  return exponent > 0 ? std::bit_cast<double>((exponent + 1) << 52) : 0;
}

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
  const DenseKernels& kernels = dense_kernels();
  const double largest = kernels.largest_size(n_, u);
  if (largest == 0) return -s;
  // The finest grid on which the sum has no more than `whole` steps.
  const double step = power_above(largest * steps_ / whole);
  const double shift = 1.5 * whole * step;
  if (!std::isnormal(step) || !std::isnormal(step * step_) || !std::isfinite(shift) ||
      !is_multiple(s, step * step_) || !kernels.is_on_grid(n_, u, shift))
    return std::nullopt;
  // Where sums are exact, their order does not matter.
  const Index whole_packs = n_ / 8 * 8;
  double sum = kernels.dot(whole_packs, u, q_);
  for (Index i = whole_packs; i < n_; ++i) sum += u[i] * q_[i];
  return sum - s;
}

}  // namespace convex::inline exact_arithmetic
