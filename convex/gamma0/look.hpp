#pragma once

namespace convex::inline gamma0 {

/// How the programs of a prox are gone about. No one choice is right for all: the scales of D that suit one
/// set of curvatures are slow for another, and an x taken from a steep term may leave a set by rounding, as
/// one taken from the set may leave the steep term's domain. The plain look is tried first, and what it does
/// not settle is looked at again; each answer is held against the values of the functions, so that a look can
/// fail and not mislead.
struct Look {
  /// Other scales of D are tried where the steps do not come to rounding.
  bool at_other_scales = false;
  /// x is taken from the terms that are steep at an end of their domain, and the multipliers of epigraphs and
  /// perspectives are made of the slopes of their functions.
  bool by_steep_terms = false;
};

}  // namespace convex::inline gamma0
