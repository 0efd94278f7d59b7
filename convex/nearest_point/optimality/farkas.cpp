#include "convex/nearest_point/optimality/farkas.hpp"
#include "convex/nearest_point/working_set/dependent_row.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "convex/invalid_input.hpp"

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
  if (w.size() != problem.rows())
    throw InvalidInput("w: " + std::to_string(w.size()) + " weights; give " + std::to_string(problem.rows()) +
                       ", one per row of U");
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

namespace {

/// A weight this small beside the largest (times the lengths of the rows) is left out.
constexpr double support = 1e-9;

}  // namespace

std::optional<Vector> farkas_circuit(const NearestPointProblem& problem, const Vector& w, double reach) {
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  const Vector length = problem.U.lengths(problem.A.diagonal().cwiseInverse());
  const Vector weight = w.cwiseAbs().cwiseProduct(length);
  if (problem.rows() == 0 || !weight.allFinite() || !(weight.maxCoeff() > 0)) return std::nullopt;
  std::vector<Index> rows;
  for (Index a = 0; a < problem.rows(); ++a)
    if (weight[a] > support * weight.maxCoeff() && (w[a] > 0 || two_sided[at(a)])) rows.push_back(a);
  std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) { return weight[a] > weight[b]; });
  WorkingSet set(problem);
  WorkingSet::Split split;
  for (Index p : rows) {
    double rest = w[p];
    bool gone = false;
    set.split(p, split);
    while (!gone && !(split.rho > 0)) {
      const double gap = contradiction(set, p, split), sign = gap < 0 ? -1 : 1;
      // The weights move by sign (1, -r); the first one-sided weight that comes to 0 stops them.
      const auto [blocking, step] =
          blocking_row(set, split, sign, sign < 0 && !two_sided[at(p)] ? rest : infinity);
      if (!std::isfinite(step)) {
        if (!(std::abs(gap) > 0)) break;  // a dependence that proves nothing
        const Vector weights = contradiction_weights(set, p, split, sign);
        if (proves_infeasibility(problem, weights, reach)) return weights;
        break;
      }
      set.lambda().head(set.size()) -= sign * step * split.coefficients.head(set.size());
      rest += sign * step;
      gone = blocking < 0;
      if (gone) break;
      set.remove(blocking);
      set.split(p, split);
    }
    if (!gone && split.rho > 0) set.append(p, split, rest);
  }
  return std::nullopt;
}

}  // namespace convex::inline optimality
