#pragma once

#include "convex/vector.hpp"

namespace convex::prox_formulas {

/// A level as the unevaluated sum top + rest: (v - top) - rest has the digits of small differences.
struct Level {
  double top = 0, rest = 0;
  double value() const { return top + rest; }
};

/// Which values a level is taken of.
enum class Values { signed_ones, absolute_ones };

/// The level with Σ max(0, v_i - level) = total, v = z or |z|; total > 0, z not empty. `top` is the largest
/// value.
Level top_level(const Vector& z, double total, Values);

/// max(0, v - level) for every entry v of z; with the sign of z_i for absolute values.
Vector above_level(const Vector& z, Level, Values);

/// Σ|z_i|.
double sum_of_absolutes(const Vector& z);

}  // namespace convex::prox_formulas
