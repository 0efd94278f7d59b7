#include "convex/nearest_point/working_set/dependent_row.hpp"

#include <cmath>

#include "convex/zero_tolerances.hpp"

namespace convex::inline working_set {
namespace {

/// Where s has no radii, the way goes on as if a gap of so many roundings were none; the end decides it
/// without rounding.
constexpr double row_gap_roundings = 16;

/// The coefficients are rounded.
constexpr double rounding_of_sum = 2;

/// A coefficient r_k whose part r_k v_k of v_p is below this part of the whole is rounding about zero.
constexpr double coefficient_noise = 64 * unit_roundoff;

}  // namespace

bool is_noise(const WorkingSet& set, Index k, const WorkingSet::Split& split) {
  return std::abs(split.coefficients[k]) * set.factor().length(k) <= coefficient_noise * split.magnitude;
}

namespace {

/// s_p - Σ r_k s_k, the sum of the sizes of its terms, what of it the rounding of s can explain, the sum of
/// the sizes of terms whose r_k is noise, and how far the radii of the rows leave open that they cancel.
struct Gap {
  double value = 0, magnitude = 0, explained = 0, dropped = 0, turn = 0;
};

Gap gap_of(const WorkingSet& set, Index p, const WorkingSet::Split& split) {
  const Vector& s = set.problem().s;
  const std::optional<DataRadii>& radii = set.problem().radii;
  DoubleDouble sum{s[p], 0};
  Gap gap{0, std::abs(s[p]), radii ? radii->s[p] : 0, 0, radii ? radii->row[p] : 0};
  for (Index k = 0; k < set.size(); ++k) {
    const DoubleDouble term = two_product(-split.coefficients[k], s[set.rows()[at(k)]]);
    if (is_noise(set, k, split)) {
      gap.dropped += std::abs(term.hi);
      continue;
    }
    sum = add(sum, term);
    gap.magnitude += std::abs(term.hi);
    if (!radii) continue;
    const Index row = set.rows()[at(k)];
    gap.explained += std::abs(split.coefficients[k]) * radii->s[row];
    gap.turn += std::abs(split.coefficients[k]) * radii->row[row];
  }
  gap.explained += (radii ? rounding_of_sum : row_gap_roundings) * unit_roundoff * gap.magnitude;
  gap.value = sum.value();
  return gap;
}

}  // namespace

double contradiction(const WorkingSet& set, Index p, const WorkingSet::Split& split) {
  const Gap gap = gap_of(set, p, split);
  const double threshold =
      gap.explained + gap.dropped + (2 * split.direction.norm() + farthest_motion * gap.turn) * set.scale();
  return std::abs(gap.value) > threshold ? gap.value : 0;
}

BlockingRow blocking_row(const WorkingSet& set, const WorkingSet::Split& split, double sign, double most) {
  BlockingRow first{-1, most};
  for (Index k = 0; k < set.size(); ++k) {
    const double r = sign * split.coefficients[k];
    if (!set.one_sided(k) || r <= 0 || is_noise(set, k, split)) continue;
    const double step = std::max(0.0, set.lambda()[k]) / r;
    if (step < first.step) first = {k, step};
  }
  return first;
}

void take_in_with_multiplier(WorkingSet& set, Index p, double multiplier, WorkingSet::Split& split) {
  for (set.split(p, split); !(split.rho > 0); set.split(p, split)) {
    const auto [blocking, step] = blocking_row(set, split, -1, multiplier);
    set.lambda().head(set.size()) += step * split.coefficients.head(set.size());
    multiplier -= step;
    if (blocking < 0) return;
    set.remove(blocking);
  }
  set.append(p, split, multiplier);
}

bool is_exact_combination(const WorkingSet& set, const WorkingSet::Split& split) {
  const double nothing = exact_dependence * split.magnitude;
  if (split.rest > nothing) return false;
  for (Index k = 0; k < set.size(); ++k)
    if (is_noise(set, k, split) && std::abs(split.coefficients[k]) * set.factor().length(k) > nothing)
      return false;
  return true;
}

bool is_flat_vertex(const WorkingSet& set, const WorkingSet::Split& split) {
  if (split.within_radii || is_exact_combination(set, split)) return false;
  bool can_give_way = false;
  for (Index k = 0; k < set.size(); ++k) {
    if (!set.one_sided(k) || is_noise(set, k, split)) continue;
    if (split.coefficients[k] < 0) return true;
    can_give_way = true;
  }
  return !can_give_way;
}

Vector contradiction_weights(const WorkingSet& set, Index p, const WorkingSet::Split& split, double sign) {
  Vector weights = Vector::Zero(set.problem().rows());
  weights[p] = sign;
  for (Index k = 0; k < set.size(); ++k)
    if (!is_noise(set, k, split)) weights[set.rows()[at(k)]] = -sign * split.coefficients[k];
  return weights;
}

}  // namespace convex::inline working_set
