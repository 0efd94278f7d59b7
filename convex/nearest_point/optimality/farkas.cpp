#include "convex/nearest_point/optimality/farkas.hpp"

#include <cmath>
#include <vector>

namespace convex::inline optimality {
namespace {

/// wᵀU may be off by so many roundings of its terms: w itself is rounded, and rows that depend on each other
/// may be rounded too.
constexpr double combination_roundings = 16;

/// A gap of so many roundings of the s it is made of is a rounded s, not a contradiction.
constexpr double gap_roundings = 16;

double largest_entry(const ConstraintRows& U, Index a) {
  double largest = 0;
  U.for_each_entry(a, [&](Index, double u) { largest = std::max(largest, std::abs(u)); });
  return largest;
}

}  // namespace

bool proves_infeasibility(const NearestPointProblem& problem, const Vector& w, double reach) {
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  DoubleDoubleVector combination(problem.dimension());
  DoubleDouble gap;
  double terms = 0, magnitude = 0, unsure = 0;  // unsure: what radii may make of the gap
  for (Index a = 0; a < problem.rows(); ++a) {
    if (w[a] == 0) continue;
    if (w[a] < 0 && !two_sided[at(a)]) return false;
    problem.U.add_multiple(a, {w[a], 0}, combination);
    gap = add(gap, two_product(w[a], problem.s[a]));
    terms += std::abs(w[a]) * largest_entry(problem.U, a);
    magnitude = std::max(magnitude, std::abs(w[a] * problem.s[a]));
    if (problem.radii) unsure += std::abs(w[a]) * (problem.radii->s[a] + problem.radii->row[a] * reach);
  }
  const Vector rest = combination.value();
  const bool combines =
      rest.size() == 0 || rest.cwiseAbs().maxCoeff() <= combination_roundings * unit_roundoff * terms;
  return combines &&
         gap.value() > gap_roundings * unit_roundoff * magnitude + problem.A.dual_norm(rest) * reach + unsure;
}

}  // namespace convex::inline optimality
