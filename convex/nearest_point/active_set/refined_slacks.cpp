#include "convex/nearest_point/active_set/refined_slacks.hpp"

#include <cmath>

#include "convex/nearest_point/active_set/dependent_row.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline dual_active_set {
namespace {

/// How far the violation of a row that is taken for 0 may leave the point from the edge of that row and S.
double moved_edge(WorkingSet& set, Index a, double violation, WorkingSet::Split& split) {
  set.split(a, split);
  return split.rest > exact_dependence * split.magnitude ? violation / split.rest : 0;
}

}  // namespace

Vector refined_slacks(WorkingSet& set, RefinedPoint& point, const Vector& row_scale) {
  const NearestPointProblem& problem = set.problem();
  const Vector q_size = point.q.hi.cwiseAbs();
  const double plain_rounding = 2 * static_cast<double>(problem.dimension()) * unit_roundoff;
  const double left = point.remaining() + point.dropped;
  Vector rest = problem.U.times(point.q.hi) - problem.s;
  WorkingSet::Split split;
  for (Index a = 0; a < problem.rows(); ++a) {
    const double s = std::abs(problem.s[a]), length = row_scale[a];
    if (set.holds(a)) {
      rest[a] = 0;
    } else if (std::abs(rest[a]) <=
               plain_rounding * (s + problem.U.absolute_dot(a, q_size)) + 2 * length * left) {
      rest[a] = slack(problem, a, point.q).value();
      if (std::abs(rest[a]) > zero_of_pairs * (s + length * set.scale()) + 2 * length * left) continue;
      if (rest[a] < 0 && problem.radii) point.dropped += 2 * moved_edge(set, a, -rest[a], split);
      rest[a] = 0;
    }
  }
  return rest;
}

}  // namespace convex::inline dual_active_set
