#include "convex/nearest_point/active_set/degenerate_rows.hpp"

#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"

namespace convex::inline dual_active_set {

std::string_view decide_degenerate_rows(WorkingSet& set, const DoubleDoubleVector& q, const Vector& row_scale,
                                        Vector& slack) {
  const NearestPointProblem& problem = set.problem();
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  std::vector<Index> degenerate;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!set.holds(a) && (slack[a] <= 0 || two_sided[at(a)])) degenerate.push_back(a);
  if (problem.radii) return degenerate.empty() ? std::string_view() : open_question::degenerate_rows;
  const std::optional<Vector> exact = slacks_if_kept(problem, q.hi, set.rows(), degenerate);
  WorkingSet::Split split;
  SlackOnEdge edge(problem, row_scale.data());
  edge.begin();
  std::vector<double> own;
  for (Index a : degenerate) {
    if (exact) break;
    set.split(a, split);
    const std::optional<double> on_edge =
        edge.slack(a, set.rows().data(), set.size(), split.coefficients.data());
    if (!on_edge && split.rho > 0) return open_question::degenerate_rows;
    if (!on_edge || *on_edge < 0 || (*on_edge > 0 && two_sided[at(a)])) return open_question::dependence;
    own.push_back(*on_edge);
  }
  for (std::size_t k = 0; k < degenerate.size(); ++k)
    slack[degenerate[k]] = exact ? (*exact)[static_cast<Index>(k)] : own[k];
  return {};
}

}  // namespace convex::inline dual_active_set
