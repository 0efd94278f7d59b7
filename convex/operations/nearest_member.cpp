#include "convex/operations/nearest_member.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

/// The ends of an interval, and what a formula finds, are right to so many roundings.
constexpr double roundings_of_a_member = 4;

Member end_or_inside(const Interval& domain, double x) {
  const auto& [low, high] = domain;
  const double inside = std::clamp(x, low, high);
  const auto margin = [](double end) {
    return std::isfinite(end) ? roundings_of_a_member * unit_roundoff * std::abs(end) : 0;
  };
  const double at_low = inside <= low + margin(low) ? margin(low) : 0,
               at_high = inside >= high - margin(high) ? margin(high) : 0;
  return {Vector::Constant(1, inside), std::max(at_low, at_high)};
}

}  // namespace

Member nearest_member(const Function& f, const Vector& x, double size) {
  const Facts facts = f.facts();
  if (facts.finite) return {x};
  if (x.size() == 1)
    if (const auto domain = domain_of_one(f))
      if (const Member inside = end_or_inside(*domain, x[0]); std::isfinite(f.evaluate(inside.at).value))
        return inside;
  const double near = std::min(size, 1.0), weight = facts.indicator ? 1 : stiffest_weight / (near * near);
  if (!std::isfinite(weight)) return {x, infinity};
  const Prox found = f.prox(x, Metric::diagonal(Vector::Constant(x.size(), weight)), Look{});
  if (found.x.size() != x.size() || !found.x.allFinite()) return {x, infinity};
  // A program finds a point of a domain but for so much, whatever it says of its error in that metric.
  const bool by_formula = dynamic_cast<const Operation*>(&f.node()) == nullptr;
  const double miss =
      by_formula ? roundings_of_a_member * unit_roundoff * length_of(found.x) : accuracy_of_prox * size;
  return {found.x, found.x == x ? 0 : miss};
}

double miss_of(const Function& f, const Vector& x, double size) {
  const Member member = nearest_member(f, x, size);
  return member.miss + length_of(member.at - x);
}

double cost_of_miss(double miss, const std::optional<Vector>& slope) {
  constexpr double where_it_bends = 4;
  if (miss == 0 || !slope) return 0;
  return slope->allFinite() ? where_it_bends * length_of(*slope) * miss : infinity;
}

}  // namespace convex::inline operations
