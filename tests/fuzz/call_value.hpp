#pragma once

#include <optional>
#include <vector>

#include "convex/gamma0/call.hpp"

namespace fuzz {

using Real = long double;
using Point = std::vector<Real>;

/// An oracle for values: f(x) straight from the definitions of docs/functions.md, in long double and without
/// the library. A point within `slack` of the size of the numbers that a set compares is in the set.
///
/// `exact` is false where a minimum over auxiliary points was searched (inf-convolution, proximal average,
/// envelope): the value is then an upper bound. None for a call that has no definition by values here.
struct CallValue {
  Real value = 0;
  bool exact = true;
  Real size = 0;  ///< the largest number that the value is made of
};
std::optional<CallValue> call_value(const convex::Call& f, const Point& x, Real slack);

/// For a point that was rounded, and for one that is to be inside.
inline constexpr Real rounded = 1e-11L, strict = 0;

/// The least value of a convex function on the line, by golden sections inside a bracket found on a grid over
/// all magnitudes; an upper bound of the minimum, and where it was found.
struct LineMinimum {
  Real at = 0, value = 0;
};
template <class F>
LineMinimum least_on_line(const F& f, const std::vector<Real>& seeds);

/// Whether the metric's product is x·y: where it is not, operations that take it have no value here.
void set_product(bool is_plain);

}  // namespace fuzz

#include "tests/fuzz/least_on_line.hpp"
