#pragma once

#include <cmath>
#include <string>

namespace cli::inline drawings {

/// The least and the largest of the numbers along an axis.
struct DrawnRange {
  double low = INFINITY, high = -INFINITY;
  double rounding = 0;  ///< of what the numbers are counted beside

  /// The numbers are differences of such as large as this, or made with them: what is nothing beside these is
  /// rounding.
  void count_beside(double size);
  void add(double x);
  double size() const;  ///< the largest magnitude
  /// All are one number but for rounding.
  bool is_constant() const;
  /// Of what is constant, room on both sides, so that it is a line and not its rounding.
  DrawnRange with_room() const;
  /// Magnitudes below rounding count as 0.
  bool begins_at_zero() const;
};

/// `set format` for the numbers of this axis, "x" or "y": with digits enough to tell them apart, and in one
/// notation.
std::string tic_format(const char* axis, const DrawnRange&);

}  // namespace cli::inline drawings
