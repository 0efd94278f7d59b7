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

}  // namespace

double GridTest::largest() {
  if (largest_ < 0) largest_ = dense_kernels().largest_size(count_, x_);
  return largest_;
}

bool GridTest::is_on(double step) {
  const double shift = 1.5 * whole * step;
  if (!(largest() <= whole * step) || !std::isfinite(shift)) return false;
  if (step <= coarsest_on_ || step >= finest_off_) return step <= coarsest_on_;
  const bool found = dense_kernels().is_on_grid(count_, x_, shift);
  (found ? coarsest_on_ : finest_off_) = step;
  return found;
}

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

std::optional<double> GridSum::step_of_sums(GridTest& rows) const {
  if (is_zero_ || rows.largest() == 0) return 0;
  if (step_ == 0) return std::nullopt;
  // The finest grid on which the sum has no more than `whole` steps.
  const double step = power_above(rows.largest() * steps_ / whole);
  if (!std::isnormal(step) || !std::isnormal(step * step_) || !rows.is_on(step)) return std::nullopt;
  return step * step_;
}

std::optional<double> GridSum::value(const double* u, double s) const {
  GridTest row(n_, u);
  const std::optional<double> step = step_of_sums(row);
  if (!step || !is_on_grid(s, *step)) return std::nullopt;
  // Where sums are exact, their order does not matter.
  const Index whole_packs = n_ / 8 * 8;
  double sum = dense_kernels().dot(whole_packs, u, q_);
  for (Index i = whole_packs; i < n_; ++i) sum += u[i] * q_[i];
  return sum - s;
}

}  // namespace convex::inline exact_arithmetic
