#include "mechanics/motion/impact.hpp"

#include <cmath>

#include "convex/nearest_point/automatic.hpp"

namespace mechanics {
namespace {

/// f'(v+) below this part of what it is the sum of is 0: a contact that the impact closed for good.
constexpr double undecided_part = 1e-12;

/// Rows and rates are rounded about so many times.
constexpr double roundings_of_rows = 64;

}  // namespace

ImpactOutcome impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts) {
  const auto m = static_cast<Index>(contacts.size());
  convex::RowMatrix U(m, A.dimension());
  Vector s(m);
  std::vector<Index> two_sided;
  for (Index a = 0; a < m; ++a) {
    const ImpactContact& contact = contacts[static_cast<std::size_t>(a)];
    U.row(a) = contact.u.transpose();
    const double e = contact.two_sided || contact.rate > 0 ? 0 : contact.restitution;
    s[a] = -(1 + e) * contact.rate;
    if (contact.two_sided) two_sided.push_back(a);
  }
  convex::NearestPointProblem problem{A, Vector::Zero(A.dimension()), convex::ConstraintRows(U), s,
                                      two_sided};
  problem.radii = convex::rounding_radii(problem, roundings_of_rows);
  convex::Solution solution = convex::automatic(problem);
  ImpactOutcome outcome;
  if (solution.status == convex::Status::infeasible) {
    for (Index a = 0; a < m; ++a)
      if (solution.farkas[a] != 0) outcome.excluding.push_back(a);
    return outcome;
  }
  outcome.rate = U * solution.q;
  for (Index a = 0; a < m; ++a) {
    const double before = contacts[static_cast<std::size_t>(a)].rate;
    const double scale = std::abs(before) + A.dual_norm(U.row(a).transpose()) * A.norm(solution.q);
    outcome.rate[a] += before;
    if (std::abs(outcome.rate[a]) <= undecided_part * scale) outcome.rate[a] = 0;
  }
  outcome.change = std::move(solution.q);
  outcome.impulse = std::move(solution.lambda);
  return outcome;
}

}  // namespace mechanics
