#pragma once

#include <optional>

#include "convex/composite/graph_form.hpp"
#include "convex/exact_program/exact_program.hpp"

namespace convex::inline proved_prox {

/// low <= f*(v) <= high, v a covector; `high` is none where it is not finite.
struct SupremumBetween {
  Fraction low;
  std::optional<Fraction> high;
};

/// Bounds of f*(v) = sup over x of v·x - f(x) that fractions decide, from a maximiser ξ = (x, w) that doubles
/// found, which need be none. A curved term h is held from above by
///   h(u) <= h(û) + Σ_i h∞(e_i) (u_i - û_i)⁺ + h∞(-e_i) (u_i - û_i)⁻,
/// û = Mξ + b and h∞ its recession function (Rockafellar 1970, theorem 8.5 and corollary 8.7.1), of one entry
/// by chords near û too, so that the supremum beside all other terms as they are is that of a linear or
/// quadratic program, and no more than f*(v). The other bound is that of tangents at û and where that program
/// has its own maximiser.
/// None where a term has no value at û, where f*(v) may be infinite, or fractions would take long.
std::optional<SupremumBetween> supremum_between(const GraphForm& f, const Vector& xi, const Fractions& v);

}  // namespace convex::inline proved_prox
