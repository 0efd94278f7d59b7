#include <algorithm>
#include <cmath>

#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/operations/two_function_max.hpp"
#include "convex/operations/weight_bracket.hpp"
#include "convex/operations/weighted_mean.hpp"

namespace convex::inline operations {
namespace {

/// The conjugate of the mean at v, and a point where its supremum is attained.
struct Above {
  double t = 0;
  Value bound;
  Vector x;
  double difference = 0;  ///< g - f there
};

/// None where it is not known: beside the least weight a program may see no domain.
std::optional<Above> above(const Function& f, const Function& g, double t, const Vector& v) {
  WorkLimit::count(WorkLimit::of_a_program);
  try {
    const Function conjugate = weighted_mean(f, g, t).sum.conjugate();
    const std::optional<Vector> x = conjugate.subgradient(v);
    if (!x || x->size() != v.size() || !x->allFinite()) return std::nullopt;
    const Above found{t, conjugate.evaluate(v), *x, g(*x) - f(*x)};
    return std::isnan(found.difference) ? std::nullopt : std::optional(found);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<Value> conjugate_of_two_function_max(const Function& f, const Function& g, const Vector& v) {
  constexpr double enough = 1e-13;
  double least = infinity, most = -infinity, error = 0;
  const auto take_point = [&](const Vector& x) {
    const Value of_f = f.evaluate(x), of_g = g.evaluate(x);
    const Value larger = of_f.value > of_g.value ? of_f : of_g;
    const Value along = product(v, x);
    const double below = along.value - larger.value - larger.error - along.error;
    if (below > most) most = below;
  };
  const auto take = [&](const std::optional<Above>& found) {
    if (!found) return;
    if (const Value& bound = found->bound; bound.value + bound.error < least + error) {
      least = bound.value;
      error = bound.error;
    }
    take_point(found->x);
  };
  std::optional<Above> low = above(f, g, 0, v), high = above(f, g, 1, v);
  take(low);
  take(high);
  if (!low || !high) return std::nullopt;
  WeightBracket bracket{0, 1, low->difference, high->difference};
  for (int step = 0; step < most_weights && !WorkLimit::passed(); ++step) {
    const bool is_open = low->difference > 0 && high->difference < 0;
    if (!is_open || !(least + error - most > enough * std::abs(least))) break;
    if (!(high->t - low->t > shortest_bracket * std::min(high->t, 1 - low->t))) break;
    const std::optional<Above> middle = above(f, g, bracket.next(), v);
    if (!middle) break;
    take(middle);
    bracket.narrow(middle->t, middle->difference);
    (middle->difference > 0 ? low : high) = middle;
    // Where the maximiser jumps both ends are ones of the mean between, and so are the points between them.
    const double part = low->difference / (low->difference - high->difference);
    if (part > 0 && part < 1) take_point(low->x + part * (high->x - low->x));
  }
  if (!std::isfinite(least) || !std::isfinite(most)) return std::nullopt;
  // A least weight that keeps a domain may put an upper bound below a lower one.
  return Value{least, error + std::abs(least - most) + unit_roundoff * (std::abs(least) + std::abs(most))};
}

}  // namespace convex::inline operations
