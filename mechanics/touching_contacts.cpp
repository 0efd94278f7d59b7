#include "mechanics/touching_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/optimality/residuals.hpp"

namespace mechanics {

std::vector<Index> touching_contacts(const convex::NearestPointProblem& problem,
                                     const convex::Solution& solution, const convex::Multipliers& multipliers,
                                     double tolerance) {
  std::vector<Index> one_sided, found;
  std::set_difference(multipliers.tight.begin(), multipliers.tight.end(), problem.two_sided.begin(),
                      problem.two_sided.end(), std::back_inserter(one_sided));
  if (one_sided.empty()) return found;
  const convex::Vector length = convex::dual_lengths(problem, multipliers.tight);
  double push = std::max(solution.acceleration_norm, solution.force_norm);
  for (const Index a : multipliers.tight)
    push = std::max(push, std::abs(multipliers.least_norm[a]) * length[a]);
  for (const Index a : one_sided) {
    double most = std::abs(multipliers.least_norm[a]);
    if (!multipliers.unique)
      most = multipliers.ranges ? (*multipliers.ranges)[static_cast<std::size_t>(a)].high
                                : std::numeric_limits<double>::infinity();
    if (most * length[a] <= tolerance * push) found.push_back(a);
  }
  return found;
}

}  // namespace mechanics
