#include "mechanics/exact_gauss_solution.hpp"

#include "convex/nearest_point/proof/exact_method.hpp"
#include "convex/nearest_point/residuals.hpp"
#include "mechanics/touching_contacts.hpp"
#include "mechanics/units.hpp"

namespace mechanics {

ExactGaussSolution solve_exactly(const convex::ExactProblem& exact,
                                 const convex::NearestPointProblem& problem, const GaussOptions& options) {
  ExactGaussSolution found;
  found.primal =
      convex::exact_active_set(exact, convex::likely_active_rows(in_units(problem, fit_units(problem))));
  GaussSolution& rounded = found.rounded;
  rounded.primal = convex::rounded(exact, found.primal, options.accuracy);
  if (found.primal.status == convex::Status::infeasible) return found;

  const bool ranges = options.always_ranges || problem.rows() <= most_ranges;
  found.multipliers = convex::exact_multipliers(exact, found.primal, ranges);
  found.reaction = convex::reaction(exact, found.multipliers.least_norm);
  // G = ½ q·Aq - z·q.
  const convex::Fraction energy = convex::squared_norm(exact, found.primal.q);
  found.gauss = energy / convex::Fraction{2, 1} -
                convex::lowest_terms(convex::dot(convex::ExactVector{exact.z, exact.unit}, found.primal.q));

  rounded.multipliers = convex::rounded(found.multipliers);
  rounded.touching = touching_contacts(problem, rounded.primal, rounded.multipliers, 0);
  rounded.reaction = convex::nearest(found.reaction);
  rounded.gauss = convex::nearest_double(found.gauss);
  rounded.primal.force_norm = problem.A.dual_norm(problem.z);
  rounded.residuals = rounded.primal.residuals = convex::residuals(
      problem, rounded.primal.q, rounded.multipliers.least_norm, Vector::Zero(problem.rows()));
  rounded.hypothesis = exact_hypothesis(exact, found.primal);
  if (problem.rows() <= most_contacts_from_dual && fit_units(problem).ordinary())
    rounded.from_dual = reaction_from_dual(problem, rounded.hypothesis.two_sided, rounded.primal);
  return found;
}

}  // namespace mechanics
