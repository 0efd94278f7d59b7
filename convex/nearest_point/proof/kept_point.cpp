#include "convex/nearest_point/proof/kept_point.hpp"

#include "convex/nearest_point/optimality/exact_slack.hpp"

namespace convex::inline proof {

std::vector<Index> loaded_rows(const Solution& solution) {
  std::vector<Index> rows;
  for (Index a = 0; a < solution.lambda.size(); ++a)
    if (solution.lambda[a] != 0) rows.push_back(a);
  return rows;
}

KktResidual residual_as_it_stands(const NearestPointProblem& problem, const RadiiOf& radii,
                                  const Solution& solution, const std::vector<Index>& rows) {
  const Vector lambda = solution.lambda(rows), still = Vector::Zero(solution.q.size());
  return kkt_residual(problem, radii, rows, {solution.q, still, lambda, Vector::Zero(lambda.size()), {}, 0});
}

std::optional<KktResidual> residual_of_kept_point(const NearestPointProblem& problem, const RadiiOf& radii,
                                                  const Solution& solution) {
  if (radii.any() || solution.lambda.size() != problem.rows()) return std::nullopt;
  const std::vector<Index> loaded = loaded_rows(solution);
  const std::vector<bool> is_loaded = marked(problem.rows(), loaded);
  std::vector<Index> others;
  for (Index a = 0; a < problem.rows(); ++a) {
    if (!is_loaded[at(a)]) others.push_back(a);
    if (!(solution.lambda[a] >= 0) && !problem.is_two_sided(a)) return std::nullopt;
  }
  if (!slacks_if_kept(problem, solution.q, loaded, others)) return std::nullopt;
  return residual_as_it_stands(problem, radii, solution, loaded);
}

}  // namespace convex::inline proof
