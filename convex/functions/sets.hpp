#pragma once

#include "convex/functions/function.hpp"

/// The sets of the language; each throws InvalidInput when it would be empty or a number is out of range.
/// Data are plain coordinates, whatever the metric.
namespace convex {

/// {x : |x - center|₂ <= radius}; about 0, in any number of entries, when center is empty. radius >= 0.
Set ball2(double radius = 1, const Vector& center = {});

/// The indicator of S, and its plain support function sup over s in S of s·v.
inline Function indicator(const Set& S) { return S.indicator; }
inline Function support(const Set& S) { return S.indicator.conjugate(); }

}  // namespace convex
