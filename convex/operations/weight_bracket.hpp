#pragma once

#include <algorithm>
#include <cmath>

namespace convex::inline operations {

/// A bracket of the root of a decreasing function on [0, 1]: the chord's root, the value of an end that stays
/// lessened (Anderson and Björck 1973); the middle where two steps did not shorten it to a quarter, or the
/// ends' values are far apart. Middles are of the exponents of t, or of 1 - t, where these are far apart.
class WeightBracket {
 public:
  WeightBracket(double low, double high, double of_low, double of_high)
      : low_(low), high_(high), of_low_(of_low), of_high_(of_high) {}

  double next() {
    constexpr double far_apart = 1e3, least_gain = 0.25;
    if (++steps_ % 2 == 0) {
      slow_ = high_ - low_ > least_gain * width_;
      width_ = high_ - low_;
    }
    const double t = low_ + (high_ - low_) * (of_low_ / (of_low_ - of_high_));
    const double ratio = std::abs(of_low_ / of_high_);
    const bool uneven = is_wide() && (ratio > far_apart || ratio < 1 / far_apart);
    const bool plain = !slow_ && !uneven && t > low_ && t < high_;
    slow_ = false;
    return plain ? t : middle();
  }
  /// Another t where nothing is known at this one.
  double beside(double t) const { return t + 0.375 * (high_ - t); }
  void narrow(double t, double value) {
    constexpr double least_part = 0.1;
    const bool is_low = value > 0;
    double &end = is_low ? low_ : high_, &of_end = is_low ? of_low_ : of_high_;
    if (same_side_ == (is_low ? 1 : -1)) {
      const double part = 1 - value / of_end;
      (is_low ? of_high_ : of_low_) *= part > least_part ? part : 0.5;
    }
    same_side_ = is_low ? 1 : -1;
    end = t;
    of_end = value;
  }

 private:
  static constexpr double far = 16;
  bool is_wide() const { return low_ < high_ / far || 1 - high_ < (1 - low_) / far; }
  double middle() const {
    constexpr double most_at_once = 1e-3;
    const double from_one = 1 - high_;
    if (low_ < high_ / far) return std::max(std::sqrt(low_) * std::sqrt(high_), high_ * most_at_once);
    if (from_one < (1 - low_) / far)
      return 1 - std::max(std::sqrt(from_one) * std::sqrt(1 - low_), (1 - low_) * most_at_once);
    return low_ + (high_ - low_) / 2;
  }
  double low_, high_, of_low_, of_high_, width_ = 1;
  int same_side_ = 0, steps_ = 0;
  bool slow_ = false;
};

}  // namespace convex::inline operations
