#include "convex/nearest_point/active_set/contradiction_within_radii.hpp"

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/reductions/left_out.hpp"

namespace convex::inline dual_active_set {

std::optional<Vector> contradiction_within_radii(const NearestPointProblem& problem, const Vector& w) {
  std::vector<Index> rows;
  for (Index a = 0; a < w.size(); ++a)
    if (w[a] != 0) rows.push_back(a);
  const Solution found = active_set_of_valid(with_rows(problem, rows), {}, {});
  if (found.status != Status::infeasible) return std::nullopt;
  Vector weights = Vector::Zero(problem.rows());
  weights(rows) = found.farkas;
  return weights;
}

}  // namespace convex::inline dual_active_set
