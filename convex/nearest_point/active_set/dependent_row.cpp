#include "convex/nearest_point/active_set/dependent_row.hpp"

#include <cmath>

namespace convex {
namespace {

/// Where s has no radii, the way goes on as if a gap of so many roundings were none; the end decides it
/// without rounding.
constexpr double gap_roundings = 16;

/// The coefficients are rounded.
constexpr double rounding_of_sum = 2;

/// A coefficient r_k whose part r_k v_k of v_p is below this part of the whole is rounding about zero.
constexpr double coefficient_noise = 64 * unit_roundoff;

}  // namespace

template <int MaxSize>
bool is_noise(const WorkingSet<MaxSize>& set, Index k, const typename WorkingSet<MaxSize>::Split& split) {
  return std::abs(split.coefficients[k]) * set.factor().length(k) <= coefficient_noise * split.magnitude;
}

namespace {

/// s_p - Σ r_k s_k, the sum of the sizes of its terms, what of it the rounding of s can explain, and the sum
/// of the sizes of terms whose r_k is noise.
struct Gap {
  double value = 0, magnitude = 0, explained = 0, silenced = 0;
};

template <int MaxSize>
Gap gap_of(const WorkingSet<MaxSize>& set, Index p, const typename WorkingSet<MaxSize>::Split& split) {
  const Vector& s = set.problem().s;
  const std::optional<DataRadii>& radii = set.problem().radii;
  DoubleDouble sum{s[p], 0};
  Gap gap{0, std::abs(s[p]), radii ? radii->s[p] : 0, 0};
  for (Index k = 0; k < set.size(); ++k) {
    const DoubleDouble term = two_product(-split.coefficients[k], s[set.rows()[static_cast<std::size_t>(k)]]);
    if (is_noise(set, k, split)) {
      gap.silenced += std::abs(term.hi);
      continue;
    }
    sum = add(sum, term);
    gap.magnitude += std::abs(term.hi);
    if (radii)
      gap.explained += std::abs(split.coefficients[k]) * radii->s[set.rows()[static_cast<std::size_t>(k)]];
  }
  gap.explained += (radii ? rounding_of_sum : gap_roundings) * unit_roundoff * gap.magnitude;
  gap.value = sum.value();
  return gap;
}

}  // namespace

template <int MaxSize>
double contradiction(const WorkingSet<MaxSize>& set, Index p,
                     const typename WorkingSet<MaxSize>::Split& split) {
  const Gap gap = gap_of(set, p, split);
  const double threshold = gap.explained + gap.silenced + 2 * split.direction.norm() * set.scale();
  return std::abs(gap.value) > threshold ? gap.value : 0;
}

template <int MaxSize>
Index blocking_row(const WorkingSet<MaxSize>& set, const typename WorkingSet<MaxSize>::Split& split) {
  Index blocking = -1;
  double least = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < set.size(); ++k) {
    const double r = split.coefficients[k];
    if (!set.one_sided(k) || r <= 0 || is_noise(set, k, split)) continue;
    const double ratio = std::max(0.0, set.lambda()[k]) / r;
    if (!(ratio < least)) continue;
    least = ratio;
    blocking = k;
  }
  return blocking;
}

template <int MaxSize>
bool is_exact_combination(const WorkingSet<MaxSize>& set, const typename WorkingSet<MaxSize>::Split& split) {
  const double nothing = exact_dependence * split.magnitude;
  if (split.rest > nothing) return false;
  for (Index k = 0; k < set.size(); ++k)
    if (is_noise(set, k, split) && std::abs(split.coefficients[k]) * set.factor().length(k) > nothing)
      return false;
  return true;
}

template <int MaxSize>
bool is_flat_wedge(const WorkingSet<MaxSize>& set, Index, const typename WorkingSet<MaxSize>::Split& split) {
  if (is_exact_combination(set, split)) return false;
  bool can_give_way = false;
  for (Index k = 0; k < set.size(); ++k) {
    if (!set.one_sided(k) || is_noise(set, k, split)) continue;
    if (split.coefficients[k] < 0) return true;
    can_give_way = true;
  }
  return !can_give_way;
}

template <int MaxSize>
Vector contradiction_weights(const WorkingSet<MaxSize>& set, Index p,
                             const typename WorkingSet<MaxSize>::Split& split, double sign) {
  Vector weights = Vector::Zero(set.problem().rows());
  weights[p] = sign;
  for (Index k = 0; k < set.size(); ++k)
    if (!is_noise(set, k, split))
      weights[set.rows()[static_cast<std::size_t>(k)]] = -sign * split.coefficients[k];
  return weights;
}

#define MOREAU_DEPENDENT_ROW(size)                                                                      \
  template bool is_noise(const WorkingSet<size>&, Index, const WorkingSet<size>::Split&);               \
  template Index blocking_row(const WorkingSet<size>&, const WorkingSet<size>::Split&);                 \
  template bool is_exact_combination(const WorkingSet<size>&, const WorkingSet<size>::Split&);          \
  template bool is_flat_wedge(const WorkingSet<size>&, Index, const WorkingSet<size>::Split&);          \
  template double contradiction(const WorkingSet<size>&, Index, const WorkingSet<size>::Split&);        \
  template Vector contradiction_weights(const WorkingSet<size>&, Index, const WorkingSet<size>::Split&, \
                                        double);
MOREAU_DEPENDENT_ROW(Eigen::Dynamic)
MOREAU_DEPENDENT_ROW(8)

}  // namespace convex
