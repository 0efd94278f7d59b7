#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/operations/order_of_doubles.hpp"

namespace convex::inline operations {

/// A bracket of the root of an increasing function, the doubles being counted in their order: by chords, the
/// value of an end that stays lessened (Anderson and Björck 1973), and every third time by the middle, which
/// bounds the number of looks where chords do not shorten the bracket.
class RootBracket {
 public:
  RootBracket(double left, double of_left, double right, double of_right)
      : left_{rank_of(left), of_left}, right_{rank_of(right), of_right} {}

  bool is_closed() const { return right_.rank <= left_.rank + 1; }
  /// Where to look next, between the ends; while it is not closed.
  double next() {
    const Rank middle = std::midpoint(left_.rank, right_.rank);
    if (++steps_ % 3 == 0) return double_of(middle);
    const double left = double_of(left_.rank), right = double_of(right_.rank);
    const double chord = left + (right - left) * (left_.value / (left_.value - right_.value));
    if (!std::isfinite(chord)) return double_of(middle);
    return double_of(std::clamp(rank_of(chord), left_.rank + 1, right_.rank - 1));
  }
  /// The function is `value` at x, which is the left end from now on where that is not above 0.
  void take(double x, double value) {
    constexpr double least_part = 0.1;
    const bool is_left = value <= 0;
    End &end = is_left ? left_ : right_, &other = is_left ? right_ : left_;
    if (last_ == &end) {
      const double part = 1 - value / end.value;
      other.value *= part > least_part ? part : 0.5;
    }
    end = {rank_of(x), value};
    last_ = &end;
  }

 private:
  struct End {
    Rank rank;
    double value;
  };
  End left_, right_;
  const End* last_ = nullptr;
  int steps_ = 0;
};

}  // namespace convex::inline operations
