#pragma once

#include "convex/infinity.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline working_set {

/// Whether the coefficient r_k of a split, measured by its part r_k v_k of v_p, is rounding about zero.
bool is_noise(const WorkingSet& set, Index k, const WorkingSet::Split& split);

/// The row of S, by its place, whose multiplier comes down to 0 first, and by how much the multiplier of the
/// row split changes until then; -1 for none.
struct BlockingRow {
  Index place = -1;
  double step = infinity;
};
/// Among one-sided rows, when the multiplier of the row split rises (sign 1) or falls (-1), by less than
/// `most`.
BlockingRow blocking_row(const WorkingSet& set, const WorkingSet::Split& split, double sign = 1,
                         double most = infinity);

/// Takes row p in with its multiplier; while it depends on S, the multiplier moves over to S, from which the
/// row that comes to 0 first is dropped (Carathéodory 1911). split: room for that of the row.
void take_in_with_multiplier(WorkingSet& set, Index p, double multiplier, WorkingSet::Split& split);

/// For a row p that depends on S: s_p - Σ r_k s_k, by which it contradicts S, when that exceeds rounding and
/// what some motion up to `farthest_motion` times the scale makes of the radii; else 0.
double contradiction(const WorkingSet& set, Index p, const WorkingSet::Split& split);

/// Whether a row is a combination of S with coefficients that are 0 or beyond rounding, nothing left over.
bool is_exact_combination(const WorkingSet& set, const WorkingSet::Split& split);

/// Whether a row counts as dependent on S by rounding alone and is opposite to one-sided rows of S, or to
/// nothing that could give way to it: as the numbers stand they meet in a vertex, however flat, that may be
/// far from where S holds them. Rows that are a combination of S within their radii leave none: which numbers
/// are meant is not known.
bool is_flat_vertex(const WorkingSet& set, const WorkingSet::Split& split);

/// sign (e_p - Σ r_k e_k): the combination of rows that cancels, over all rows of the problem.
Vector contradiction_weights(const WorkingSet& set, Index p, const WorkingSet::Split& split, double sign);

}  // namespace convex::inline working_set
