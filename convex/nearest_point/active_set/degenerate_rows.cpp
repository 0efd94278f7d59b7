#include "convex/nearest_point/active_set/degenerate_rows.hpp"

#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"

namespace convex::inline dual_active_set {
namespace {

/// Whether the doubles q, on the rows S without rounding, are the point of S: a vertex, or in balance. Of
/// others their rounding may have made a slack of 0.
bool is_exact(const WorkingSet& set, const RefinedPoint& refined) {
  if (set.size() == set.problem().dimension()) return true;
  DoubleDoubleVector lambda(set.problem().rows());
  for (Index k = 0; k < set.size(); ++k) {
    lambda.hi[set.rows()[at(k)]] = refined.lambda.hi[k];
    lambda.lo[set.rows()[at(k)]] = refined.lambda.lo[k];
  }
  return is_in_balance(set.problem(), refined.q.hi, lambda);
}

}  // namespace

std::string_view decide_degenerate_rows(WorkingSet& set, const RefinedPoint& refined, const Vector& row_scale,
                                        Vector& slack) {
  const NearestPointProblem& problem = set.problem();
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  std::vector<Index> degenerate;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!set.holds(a) && (slack[a] <= 0 || two_sided[at(a)])) degenerate.push_back(a);
  if (problem.radii) return degenerate.empty() ? std::string_view() : open_question::degenerate_rows;
  const std::optional<Vector> kept = slacks_if_kept(problem, refined.q.hi, set.rows(), degenerate);
  const bool is_solution = kept && is_exact(set, refined);
  WorkingSet::Split split;
  SlackOnEdge edge(problem, row_scale.data());
  edge.begin();
  Vector told = Vector::Zero(static_cast<Index>(degenerate.size()));
  std::string_view open;
  for (Index k = 0; k < told.size(); ++k) {
    const Index a = degenerate[at(k)];
    if (is_solution || (kept && (*kept)[k] == 0)) {
      told[k] = (*kept)[k];
      continue;
    }
    set.split(a, split);
    const std::optional<double> on_edge =
        edge.slack(a, set.rows().data(), set.size(), split.coefficients.data());
    if (on_edge && (*on_edge == 0 || (*on_edge > 0 && !two_sided[at(a)])))
      told[k] = *on_edge;
    else if (kept)
      open = open_question::zero_slacks;
    else
      return !on_edge && split.rho > 0 ? open_question::degenerate_rows : open_question::dependence;
  }
  slack(degenerate) = told;
  return open;
}

}  // namespace convex::inline dual_active_set
