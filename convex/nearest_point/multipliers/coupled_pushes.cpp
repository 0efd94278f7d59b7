#include "convex/nearest_point/multipliers/coupled_pushes.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/reductions/islands.hpp"

namespace convex::inline multiplier_sets {

CoupledPushes coupled_pushes(const NearestPointProblem& problem, const Solution& solution,
                             const Vector& lambda, const std::vector<Index>& rows, const Vector& length) {
  const Islands islands = find_islands(problem);
  const double of_whole = std::max(solution.acceleration_norm, solution.force_norm);
  Vector pushes = Vector::Zero(std::max<Index>(1, islands.count)),
         others = Vector::Constant(pushes.size(), of_whole);
  if (islands.count > 1) {  // ||·||_D and ||·||_(D⁻¹) stand for the norms, D the diagonal of A
    const Vector unit = problem.A.diagonal().cwiseSqrt();
    Vector z = Vector::Zero(others.size()), q = z;
    for (Index i = 0; i < problem.dimension(); ++i) {
      const Index island = islands.of_coordinate[at(i)];
      z[island] = std::hypot(z[island], problem.z[i] / unit[i]);  // squares may leave the range of doubles
      q[island] = std::hypot(q[island], solution.q[i] * unit[i]);
    }
    others = z.cwiseMax(q);
  }
  for (const Index a : rows)
    if (const Index island = islands.of_row[at(a)]; island >= 0)
      pushes[island] = std::max(pushes[island], std::abs(lambda[a]) * length[a]);
  CoupledPushes found{Vector::Zero(problem.rows()), Vector::Constant(problem.rows(), of_whole)};
  for (const Index a : rows)
    if (const Index island = islands.of_row[at(a)]; island >= 0) {
      found.pushes[a] = pushes[island];
      found.others[a] = others[island];
    }
  return found;
}

}  // namespace convex::inline multiplier_sets
