#include "convex/nearest_point/sparse/sparse_contradiction.hpp"

#include <algorithm>

#include "convex/nearest_point/active_set/active_set_answer.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/proof/infeasibility_proof.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline sparse {

Solution sparse_contradiction(const NearestPointProblem& problem, const BalancedProblem& scaled,
                              RowSystem& system, const Vector& lambda) {
  constexpr double growing = 1e-4;
  constexpr int most_projections = 20;
  Solution solution;
  const double largest = lambda.cwiseAbs().maxCoeff();
  std::vector<Index> rows;
  Vector weight = Vector::Zero(problem.rows()), w = Vector::Zero(problem.rows());
  for (Index a = 0; a < problem.rows(); ++a)
    if (std::abs(lambda[a]) > growing * largest) {
      rows.push_back(a);
      weight[a] = 1e6;  // A is then a small part of A + UᵀDU
      w[a] = lambda[a] / largest * scaled.multiplier[a];
    }
  if (!system.factor(weight)) return solution;
  for (int k = 0; k < most_projections; ++k) {
    DoubleDoubleVector sum(problem.dimension());
    for (Index a : rows) problem.U.add_multiple(a, {w[a], 0}, sum);
    const Vector rest = sum.value().cwiseQuotient(scaled.linear);
    const Vector along = scaled.U * system.solve(rest);
    for (Index a : rows) w[a] -= weight[a] * along[a] * scaled.multiplier[a];
  }
  for (Index a : rows)
    if (!scaled.two_sided[at(a)]) w[a] = std::max(0.0, w[a]);
  const double reach = farthest_motion * problem.A.dual_norm(problem.z);
  if (!w.allFinite() || !(w.cwiseAbs().maxCoeff() > 0)) return solution;
  solution.farkas = w / w.cwiseAbs().maxCoeff();
  if (!proves_infeasibility(problem, solution.farkas, reach)) return solution;
  if (problem.radii) {
    std::optional<Vector> proved = solution.farkas;
    if (is_dense_size(problem)) proved = contradiction_within_radii(problem, solution.farkas);
    if (!proved) return solution;
    solution.farkas = *std::move(proved);
    solution.status = Status::infeasible;
  } else if (std::optional<InfeasibilityProof> proof = infeasibility_proof(problem, solution.farkas)) {
    solution.farkas = std::move(proof->farkas);
    solution.status = Status::infeasible;
  } else {
    solution.undecided = open_question::contradiction;
  }
  return solution;
}

}  // namespace convex::inline sparse
