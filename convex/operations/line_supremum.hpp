#pragma once

#include <functional>

#include "convex/gamma0/function.hpp"
#include "convex/infinity.hpp"
#include "convex/interval.hpp"

namespace convex::inline operations {

/// A point where v x - f(x) is greatest up to `value.error`, and what it is there: a lower bound alone, less
/// its rounding, where the error is infinite.
struct LineSupremum {
  double x = 0;
  Value value;
  /// Where it is attained, for certain: where φ is smooth values alone tell that to the root of their
  /// rounding.
  Interval around{-infinity, infinity};
};

/// f*(v) = sup_x v x - f(x) of a function of one entry, from values of f alone: φ(x) = v x - f(x) is concave,
/// so that a chord lies above φ beyond both of its ends. Points around the greatest value found, the doubles
/// being counted in their order, come together until the chords beside them leave rounding; the scale of the
/// maximiser is then no matter, be it 1e-200 from 0, where the domain may end with an infinite slope.
///
/// `start`: a point with f(start) < inf, the nearer to the maximiser the better. The error counts the chords
/// and the errors of the values. It is infinite where no double to the right or to the left of all has a
/// lower φ, as of a supremum that is not attained or is farther away than doubles go, and where a value is
/// not known. None where φ is not known at the start.
std::optional<LineSupremum> line_supremum(const Function& f, double v, double start);

/// A convex function of one variable.
using LineValues = std::function<Value(double)>;

/// Its least value, from `start` in the same way; the error is infinite where none is found between doubles.
Value least_on_line(const LineValues& f, double start);

}  // namespace convex::inline operations
