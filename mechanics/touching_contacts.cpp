#include "mechanics/touching_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/multipliers/coupled_pushes.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/zero_tolerances.hpp"

namespace mechanics {
namespace {

/// What is looked at as no force beside the largest one.
double zero_part(const convex::NearestPointProblem& problem) {
  return problem.radii ? convex::zero_where_z_is_rounded : convex::zero_in_doubles;
}

/// Rows are looked at one by one up to so many; each look is a solution.
constexpr std::size_t most_looks = 20;

/// Multipliers are compared with their own errors up to so many; each takes a solution.
constexpr std::size_t most_directions = 64;

/// Is the acceleration the same without the rows `left_out`, in order, beside this size?
bool is_same_without(const std::vector<Index>& left_out, const convex::NearestPointProblem& problem,
                     const convex::Solution& solution, double size) {
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
  return moved <= solution.error_bound + found.error_bound + zero_part(problem) * size;
}

/// The direction that feels one of the tight rows alone; none where that depends on the others.
std::optional<convex::Vector> direction_of(Index row, const convex::NearestPointProblem& problem,
                                           const std::vector<Index>& tight) {
  const auto count = static_cast<Index>(tight.size());
  convex::Vector s = convex::Vector::Zero(count);
  std::vector<Index> all;
  for (Index k = 0; k < count; ++k) {
    if (tight[static_cast<std::size_t>(k)] == row) s[k] = 1;
    all.push_back(k);
  }
  convex::Solution found =
      convex::automatic({problem.A, convex::Vector::Zero(problem.dimension()), problem.U.select(tight),
                         std::move(s), std::move(all), convex::select(problem.radii, tight)});
  if (found.status != convex::Status::solved) return std::nullopt;
  return std::move(found.q);
}

}  // namespace

void leave_out_pressing(std::vector<Index>& touching, const convex::NearestPointProblem& problem,
                        const convex::Solution& solution, const convex::Multipliers& multipliers,
                        const convex::Vector& balance) {
  const convex::Vector& lambda = multipliers.least_norm;
  const auto in_question =
      std::count_if(touching.begin(), touching.end(), [&](Index a) { return lambda[a] != 0; });
  if (in_question > static_cast<std::ptrdiff_t>(most_directions)) return;
  std::erase_if(touching, [&](Index a) {
    if (lambda[a] == 0) return false;
    const auto d = direction_of(a, problem, multipliers.tight);
    return d && std::abs(lambda[a]) > problem.A.norm(*d) * solution.error_bound + d->cwiseAbs().dot(balance);
  });
}

bool may_press(const std::vector<Index>& touching, const convex::NearestPointProblem& problem,
               const convex::Multipliers& multipliers) {
  if (touching.size() > most_directions || (!multipliers.unique && !multipliers.ranges)) return false;
  return std::any_of(touching.begin(), touching.end(), [&](Index a) {
    const double most = multipliers.unique ? multipliers.least_norm[a]
                                           : (*multipliers.ranges)[static_cast<std::size_t>(a)].high;
    return most != 0 && !direction_of(a, problem, multipliers.tight);
  });
}

std::vector<Index> touching_contacts(const convex::NearestPointProblem& problem,
                                     const convex::Solution& solution, const convex::Multipliers& multipliers,
                                     double tolerance) {
  std::vector<Index> one_sided, found;
  std::set_difference(multipliers.tight.begin(), multipliers.tight.end(), problem.two_sided.begin(),
                      problem.two_sided.end(), std::back_inserter(one_sided));
  if (one_sided.empty()) return found;
  const convex::Vector length = convex::dual_lengths(problem, multipliers.tight);
  const auto forces =
      convex::coupled_pushes(problem, solution, multipliers.least_norm, multipliers.tight, length);
  const convex::Vector push = forces.pushes.cwiseMax(forces.others);
  double size = solution.acceleration_norm;
  std::vector<Index> weak;
  for (const Index a : one_sided) {
    double most = std::abs(multipliers.least_norm[a]);
    if (!multipliers.unique)
      most = multipliers.ranges ? (*multipliers.ranges)[static_cast<std::size_t>(a)].high
                                : std::numeric_limits<double>::infinity();
    if (most * length[a] <= std::min(tolerance, zero_part(problem)) * push[a]) {
      found.push_back(a);
    } else if (most * length[a] <= tolerance * push[a]) {
      weak.push_back(a);
      size = std::min(size, push[a]);
    }
  }
  if (weak.empty()) return found;
  if (!is_same_without(weak, problem, solution, size)) {
    const bool one_by_one = multipliers.unique && weak.size() > 1 && weak.size() <= most_looks;
    std::erase_if(weak,
                  [&](Index a) { return !one_by_one || !is_same_without({a}, problem, solution, size); });
  }
  std::vector<Index> all;
  std::merge(found.begin(), found.end(), weak.begin(), weak.end(), std::back_inserter(all));
  return all;
}

}  // namespace mechanics
