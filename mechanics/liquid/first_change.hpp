#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace mechanics::liquid {

/// A number, and what rounding may have done to it: its sign is known where it is larger than that.
struct RoundedValue {
  double value = 0, rounding = 0;
  bool is_certain() const { return std::abs(value) > rounding; }
};

/// A number that depends on a parameter, with what is known of its sign.
struct SignedFamily {
  std::function<std::optional<RoundedValue>(double)> value;  ///< none where there is none
  /// Shown between two values: it stays below 0, or (false) it does not fall below 0. Empty: nothing is
  /// shown.
  std::function<bool(double, double, bool)> keeps_sign;
  double finest = 0x1p-30;  ///< intervals are halved to this part of the parameter
  int most_trials = 1000;   ///< with so many intervals and values tried, the rest is searched by values alone
};

/// The first change of sign on the way from a value.
struct FirstChange {
  std::optional<std::pair<double, double>> between;  ///< the nearer value first
  /// The nearest value from which on a nearer change is not excluded. None: none was passed, and where none
  /// was found there is none as far as the search went.
  std::optional<double> unshown;
};

/// Distances from a millionth to a million times the size of `start`, both ways; a way ends where the number
/// ends, and where rounding hides two values in a row. An interval in which a change is not excluded is
/// halved.
FirstChange find_first_change(const SignedFamily&, double start);

}  // namespace mechanics::liquid
