#include "convex/nearest_point/empty_wedge.hpp"

#include <algorithm>
#include <limits>

#include "convex/nearest_point/dependent_row.hpp"

namespace convex {

void doubt_empty_wedges(const NearestPointProblem& problem, Solution& solution) {
  if (solution.status != Status::solved || solution.basis.empty() ||
      solution.slack.size() != problem.rows() || !(solution.slack.minCoeff() < 0))
    return;
  const auto is_two_sided = [&](Index a) {
    return std::binary_search(problem.two_sided.begin(), problem.two_sided.end(), a);
  };
  WorkingSet<Eigen::Dynamic> set(problem);
  WorkingSet<Eigen::Dynamic>::Split split;
  const auto hold = [&](bool two_sided) {
    for (Index a : solution.basis) {
      if (is_two_sided(a) != two_sided) continue;
      set.split(a, split);
      if (split.rho > 0) set.append(a, split, 0);
    }
  };
  hold(true);
  set.fix();
  hold(false);
  for (Index a = 0; a < problem.rows(); ++a) {
    if (!(solution.slack[a] < 0) || set.holds(a) || is_two_sided(a)) continue;
    set.split(a, split);
    const bool spanned = !(split.rho > 0) || set.size() == set.factor().capacity();
    if (!spanned || !is_empty_wedge(set, a, split)) continue;
    solution.error_bound = std::numeric_limits<double>::infinity();
    solution.status = Status::inaccurate;
    return;
  }
}

}  // namespace convex
