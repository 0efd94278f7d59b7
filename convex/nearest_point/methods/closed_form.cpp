#include "convex/nearest_point/methods/closed_form.hpp"

#include <cmath>

#include "convex/invariant.hpp"
#include "convex/nearest_point/active_set/active_set_answer.hpp"
#include "convex/nearest_point/active_set/degenerate_rows.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"

namespace convex::inline algorithms {

std::optional<Solution> closed_form(const NearestPointProblem& problem, const Accuracy& accuracy) {
  invariant(problem.rows() <= 1, "the closed form is for at most one row");
  const Vector row_scale = problem.U.lengths(problem.A.diagonal().cwiseInverse());
  if (problem.rows() == 1 && !std::isnormal(row_scale[0] * row_scale[0])) return std::nullopt;
  WorkingSet set(problem);
  set.solve();
  const bool is_two_sided = !problem.two_sided.empty(), is_one_sided = problem.rows() == 1 && !is_two_sided;
  if (is_two_sided || (is_one_sided && problem.U.times(set.point())[0] < problem.s[0])) {
    WorkingSet::Split split;
    set.split(0, split);
    set.append(0, split, 0);
    set.solve();
  }
  RefinedPoint point = refine(set);
  if (is_one_sided && set.holds(0) && !(point.lambda.hi[0] > 0)) {  // what doubles saw violated was rounding
    set.remove(0);
    set.solve();
    point = refine(set);
  }
  Vector rest = refined_slacks(set, point, row_scale);
  const bool held = set.size() == 1;
  if (!(point.contraction < trusted_contraction)) return std::nullopt;
  if (!held && is_one_sided && rest[0] > 0)
    rest[0] = slack(problem, 0, point.q).value();
  else if (!held && is_one_sided &&
           (rest[0] < 0 || (!problem.radii && !decide_degenerate_rows(set, point, row_scale, rest).empty())))
    return std::nullopt;
  Solution found = certified_answer(set, point, rest, row_scale, 0, accuracy, held ? 1 : 0);
  found.method = held ? "closed-form" : "unconstrained";
  return found;
}

}  // namespace convex::inline algorithms
