#include "mechanics/touching_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/zero_tolerances.hpp"

namespace mechanics {
namespace {

/// What counts as no force beside the largest one.
double zero_part(const convex::NearestPointProblem& problem) {
  return problem.radii ? convex::zero_where_z_is_rounded : convex::zero_in_doubles;
}

/// Rows are looked at one by one up to so many; each look is a solution.
constexpr std::size_t most_looks = 20;

/// Is the acceleration the same without the rows `left_out`, in order?
bool is_same_without(const std::vector<Index>& left_out, const convex::NearestPointProblem& problem,
                     const convex::Solution& solution) {
  std::vector<Index> kept, two_sided;
  for (Index a = 0; a < problem.rows(); ++a) {
    if (std::binary_search(left_out.begin(), left_out.end(), a)) continue;
    if (problem.is_two_sided(a)) two_sided.push_back(static_cast<Index>(kept.size()));
    kept.push_back(a);
  }
  const convex::Solution found =
      convex::automatic({problem.A, problem.z, problem.U.select(kept), problem.s(kept), std::move(two_sided),
                         convex::select(problem.radii, kept)});
  if (found.status != convex::Status::solved) return false;
  const double moved = problem.A.norm(found.q - solution.q);
  return moved <= solution.error_bound + found.error_bound + zero_part(problem) * solution.acceleration_norm;
}

}  // namespace

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
  std::vector<Index> weak;
  for (const Index a : one_sided) {
    double most = std::abs(multipliers.least_norm[a]);
    if (!multipliers.unique)
      most = multipliers.ranges ? (*multipliers.ranges)[static_cast<std::size_t>(a)].high
                                : std::numeric_limits<double>::infinity();
    if (most * length[a] <= std::min(tolerance, zero_part(problem)) * push)
      found.push_back(a);
    else if (most * length[a] <= tolerance * push)
      weak.push_back(a);
  }
  if (weak.empty()) return found;
  if (!is_same_without(weak, problem, solution)) {
    const bool one_by_one = multipliers.unique && weak.size() > 1 && weak.size() <= most_looks;
    std::erase_if(weak, [&](Index a) { return !one_by_one || !is_same_without({a}, problem, solution); });
  }
  std::vector<Index> all;
  std::merge(found.begin(), found.end(), weak.begin(), weak.end(), std::back_inserter(all));
  return all;
}

}  // namespace mechanics
