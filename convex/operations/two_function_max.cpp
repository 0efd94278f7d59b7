#include "convex/operations/two_function_max.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/metric_difference.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/weight_bracket.hpp"
#include "convex/operations/weight_range.hpp"
#include "convex/operations/weighted_mean.hpp"

namespace convex::inline operations {
namespace {

/// Of a weight so small 1 less the other has lost these digits.
constexpr double nearly_nothing = 1e-3;

/// A drop of g - f says how x follows it where it is so much more than noise.
constexpr double above_noise = 1e3, safety = 4;
/// A difference that moves x by less than this part of what a prox aims at has ended the search.
constexpr double part_left = 0.25;
/// So much of the larger value the maximum may be above the mean then: where one function is steep, a small
/// move of x is a large one of its value.
constexpr double part_above = 1e-10;

/// The prox at a weight, and g - f there.
struct At {
  double t = 0;
  Function mean;
  Prox prox;
  double difference = 0;
  double noise = 0;            ///< of the difference
  Value above;                 ///< of the maximum above the mean with these weights
  double size = 0;             ///< of the larger value
  double rounding = 0;         ///< of the weights, as one of t
  double residual = infinity;  ///< from z, in ||·||_W, to the point whose prox x is
  double move = infinity;      ///< of the difference, by what x misses of the prox at z

  ProxOfMean at_z() const { return {t, rounding, prox.error_bound, difference, noise + move}; }
  ProxOfMean beside_z() const { return {t, rounding, residual, difference, noise}; }
  bool is_sure() const { return std::abs(difference) > noise; }
};

std::optional<At> at(const Function& f, const Function& g, double t, const Vector& z, const Metric& W,
                     const Look& look, TermOrder order = TermOrder::given) {
  const auto [of_f, of_g, mean] = weighted_mean(f, g, t, order);
  WorkLimit::count(WorkLimit::of_a_program);
  At found{t, mean, mean.prox(z, W, look), 0, 0, {}, 0, 0, infinity, infinity};
  if (found.prox.status != Status::solved || found.prox.x.size() != z.size()) return std::nullopt;
  const Value of_g_there = g.evaluate(found.prox.x), of_f_there = f.evaluate(found.prox.x);
  found.difference = of_g_there.value - of_f_there.value;
  found.noise = of_g_there.error + of_f_there.error;
  found.size = std::max(std::abs(of_g_there.value), std::abs(of_f_there.value));
  if (std::isnan(found.difference)) return std::nullopt;
  const double missed = found.difference > 0 ? of_f : -of_g;
  found.above = {missed * found.difference, std::abs(missed) * found.noise};
  found.rounding = unit_roundoff * t + (of_f - (1 - t)) + (of_g - t);
  return found;
}

/// At t = 0, or on the right 1, or at the next weight from there on where the prox is found. At an end one of
/// the functions keeps its domain alone, which may be harder than a mean of both. None where the two change
/// places nearer to the end.
std::optional<At> near_end(const Function& f, const Function& g, bool right, const Vector& z, const Metric& W,
                           const Look& look) {
  for (const double from_end : {0.0, 1e-9, 1e-6, 1e-3, 1e-1}) {
    if (WorkLimit::passed()) break;
    auto found = at(f, g, right ? 1 - from_end : from_end, z, W, look);
    if (!found) continue;
    const bool on_its_side = right ? found->difference <= 0 : found->difference >= 0;
    return from_end == 0 || on_its_side ? found : std::nullopt;
  }
  return std::nullopt;
}

/// Within `miss` of x, in ||·||_W, f moves by no more than this: at the corners of a cross-polytope around
/// the ball it is largest, and by convexity it falls from x by no more than it rises on the other side.
/// Corners outside the domain tell nothing; the slope at x does.
double move_of_value(const Function& f, const Vector& x, double miss, const Metric& W) {
  const Index n = x.size();
  const double here = f(x), reach = miss * std::sqrt(static_cast<double>(n));
  double most = 0;
  bool is_inside = true;
  for (Index i = 0; i < n; ++i) {
    const Vector move = reach * W.unwhiten(Vector::Unit(n, i));
    for (const Vector& corner : {Vector(x + move), Vector(x - move)}) {
      const double there = f(corner);
      if (std::isfinite(there)) most = std::max(most, there - here);
      is_inside = is_inside && std::isfinite(there);
    }
  }
  if (is_inside) return most;
  const std::optional<Vector> slope = f.subgradient(x);
  return slope ? std::max(most, miss * W.dual_norm(*slope)) : most;
}

/// W(x - z) + v, v the mean of the slopes of f and g at x: the dual norm is how far from z the point is whose
/// prox x is.
struct Residual {
  Vector covector, rounding;
  double norm(const Metric& W, const MetricScales& scales) const {
    return W.dual_norm(covector) + scales.dual_norm_of_size(rounding, false);
  }
};
std::optional<Residual> residual_of_mean(const Function& f, const Function& g, double t, const Vector& x,
                                         const Vector& z, const Metric& W) {
  constexpr double of_slopes = 4;
  const auto of_f = f.subgradient(x), of_g = g.subgradient(x);
  if (!of_f || !of_g) return std::nullopt;
  const Vector moved = composite::metric_difference(W, x, z);
  const Vector size = moved.cwiseAbs() + (1 - t) * of_f->cwiseAbs() + t * of_g->cwiseAbs();
  return Residual{moved + (1 - t) * *of_f + t * *of_g, of_slopes * unit_roundoff * size};
}

/// What is left of the difference, or may be.
double left(const At& found) { return std::max(std::abs(found.difference), found.noise); }

/// The conjugate of the maximum is at most that of a mean, and the maximum is so much more than the mean.
Prox named(const At& at_weight) {
  Prox made = at_weight.prox;
  const Function& mean = at_weight.mean;
  const bool is_one = at_weight.t == 0 || at_weight.t == 1;
  if (!made.values && (is_one || mean.facts().piecewise_quadratic)) {
    try {
      made.values = {mean.evaluate(made.x), mean.conjugate().evaluate(made.v), 0};
    } catch (const InvalidInput&) {  // beside the least weight a program may see no domain
    }
  }
  made = with_values(made, made.values, at_weight.above);
  made.method = "dual of a maximum, " + made.method;
  return made;
}

}  // namespace

std::optional<Prox> prox_of_part_above(std::span<const Function> parts, const Vector& z, const Metric& W,
                                       const Look& look) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!parts_of_max(parts[k]).empty()) continue;
    // What is not finite everywhere keeps the least weight, and with it its domain.
    std::vector<Function> terms{parts[k]};
    for (std::size_t j = 0; j < parts.size(); ++j)
      if (j != k && !parts[j].facts().finite) terms.push_back(weighted(parts[j], least_weight));
    const Function mean = terms.size() == 1 ? parts[k] : proper_sum(terms);
    At alone{0, mean, mean.prox(z, W, look), 0, 0, {}, 0, 0, infinity, infinity};
    if (alone.prox.status != Status::solved || alone.prox.x.size() != z.size()) continue;
    const Value own = parts[k].evaluate(alone.prox.x);
    const auto is_below = [&](const Function& other) {
      const Value there = other.evaluate(alone.prox.x);
      return there.value + there.error < own.value - own.error;
    };
    std::size_t below = 0;
    for (std::size_t j = 0; j < parts.size(); ++j) below += j != k && is_below(parts[j]) ? 1 : 0;
    if (below + 1 == parts.size()) return named(alone);
  }
  return std::nullopt;
}

namespace {

/// How far what the prox of a mean misses may move g - f, and the part of its residual that it is.
struct Scatter {
  double move = 0, residual = 0;
  /// Of another prox near to this.
  double at(double other) const { return move * (other > residual ? other / residual : 1); }
};

/// The same mean with its terms in the other order comes another way to the same prox, and what the two
/// differ by is the error of either, as their residuals are to each other. Where that way leads nowhere, it
/// is what the residual is worth along the path of x over t, whose slope is that of the prox by its residual;
/// where that is not known either, the most that f and g move by within the error bound.
Scatter scatter(const Function& f, const Function& g, const At& from, const Vector& path, const Vector& z,
                const Metric& W, const Look& look, const MetricScales& scales) {
  const Vector& x = from.prox.x;
  const double miss = from.prox.error_bound;
  const auto own = residual_of_mean(f, g, from.t, x, z, W);
  const auto turned = x.isZero(0) ? std::nullopt : at(f, g, from.t, z, W, look, TermOrder::turned);
  if (turned && std::isfinite(turned->difference)) {
    const auto other = residual_of_mean(f, g, from.t, turned->prox.x, z, W);
    const double others = other ? other->norm(W, scales) : 0;
    const double part = own && other ? from.residual / (from.residual + others) : 1;
    double rounded = 0;
    for (const Function& one : {f, g})
      if (const auto slope = one.subgradient(x)) rounded += slope->cwiseAbs().dot(x.cwiseAbs());
    const double apart = std::abs(turned->difference - from.difference);
    return {unit_roundoff * rounded + safety * part * apart, from.residual};
  }
  if (own && path.size() > 0 && !x.isZero(0)) {
    const double worth = std::abs(path.dot(own->covector)) + path.cwiseAbs().dot(own->rounding);
    return {safety * worth, from.residual};
  }
  return {move_of_value(f, x, miss, W) + move_of_value(g, x, miss, W), from.residual};
}

enum class Order { given, reversed };

/// How far from the weight of a prox the sign of g - f is sure, as far as its fall over t tells, or where t*
/// is known to be so near that it counts no more than what the prox itself misses.
double step_to_sure_sign(const At& from, double fall) {
  constexpr double more = 2;
  const double noise = from.noise + (std::isfinite(from.move) ? from.move : 0);
  const double open = std::abs(from.difference) + noise;
  const double unfelt = from.prox.error_bound * (from.prox.error_bound / open);
  const double least = shortest_bracket * std::min(from.t, 1 - from.t);
  double step = std::max(least, std::isfinite(unfelt) ? unfelt : 0.0);
  if (fall > 0) step = std::max(step, more * (open + noise) / fall);
  return step;
}

std::optional<Prox> prox_of_two_function_max(const Function& f, const Function& g, const Vector& z,
                                             const Metric& W, const Look& look, Order order) {
  std::optional<At> low = near_end(f, g, false, z, W, look);
  // f alone is above g at its prox
  if (low && low->t == 0 && low->difference + low->noise <= 0) return named(*low);
  std::optional<At> high = near_end(f, g, true, z, W, look);
  if (high && high->t == 1 && high->difference - high->noise >= 0) return named(*high);
  if (!low || !high) return std::nullopt;
  WeightRange range;
  const MetricScales scales = metric_scales(W);
  std::vector<At> seen;
  std::optional<Scatter> scattered;
  Vector path;  // of x over t, while the difference of the ends is more than noise
  const auto take = [&](At found) {
    constexpr double as_good = 4;
    const auto residual = residual_of_mean(f, g, found.t, found.prox.x, z, W);
    if (residual) found.residual = residual->norm(W, scales);
    if (!(found.residual <= as_good * found.prox.error_bound)) {
      if (!scattered) scattered = scatter(f, g, found, path, z, W, look, scales);
      found.move = scattered->at(found.residual);
    }
    range.learn(found.at_z());
    range.learn(found.beside_z());
    seen.push_back(std::move(found));
  };
  double moved_per_difference = 0;  // while the difference of the ends is more than noise
  double fall = 0;                  // of the difference over t, likewise
  // Where noise hides the sign at an end the root is there or beyond, as far as is known.
  WeightBracket bracket{low->t, high->t, std::max(low->difference, low->noise),
                        std::min(high->difference, -high->noise)};
  for (int step = 0; step < most_weights && !WorkLimit::passed(); ++step) {
    const double drop = low->difference - high->difference;
    const double apart = W.norm(low->prox.x - high->prox.x);
    if (std::isfinite(drop) && drop > above_noise * (low->noise + high->noise)) {
      moved_per_difference = apart / drop;
      fall = drop / (high->t - low->t);
      path = (high->prox.x - low->prox.x) / (high->t - low->t);
    }
    if (!low->is_sure() && !high->is_sure()) break;  // what they say of the root is noise
    if (!(high->t - low->t > shortest_bracket * std::min(high->t, 1 - low->t))) break;
    // The weight of f, 1 - t, is known to roundings of 1: the other way round it is t.
    if (1 - low->t < nearly_nothing && order == Order::given)
      return prox_of_two_function_max(g, f, z, W, look, Order::reversed);
    std::optional<At> middle;
    // What is beside t is t itself in the end, for rounding keeps it below the bracket's.
    double before = low->t;
    for (double t = bracket.next(); !middle && t > before && t < high->t && !WorkLimit::passed();) {
      middle = at(f, g, t, z, W, look);
      before = t;
      t = bracket.beside(t);
    }
    if (!middle && WorkLimit::passed()) break;
    if (!middle) return std::nullopt;
    const bool is_near = middle->above.value <= part_above * middle->size + middle->above.error &&
                         moved_per_difference > 0 &&
                         safety * moved_per_difference * left(*middle) <=
                             part_left * accuracy_of_prox * (W.norm(z) + W.norm(middle->prox.x));
    if (middle->difference == 0 || is_near) {
      low = high = middle;
      break;
    }
    bracket.narrow(middle->t, middle->difference);
    (middle->difference > 0 ? low : high) = std::move(middle);
  }
  const bool take_low = std::abs(low->difference) <= std::abs(high->difference);
  take(take_low ? *low : *high);
  if (high->t != low->t) take(take_low ? *high : *low);
  const auto error_of = [&](const At& found) {
    return std::min(range.error_of(found.at_z()), range.error_of(found.beside_z()));
  };
  // Of those that are as near, that whose mean is nearest to the maximum.
  const auto best = [&] {
    constexpr double as_near = 2;
    double least = infinity;
    for (const At& one : seen) least = std::min(least, error_of(one));
    const At* found = &seen.front();
    for (const At& one : seen) {
      const bool is_near = error_of(one) <= as_near * least, was_near = error_of(*found) <= as_near * least;
      if (is_near && (!was_near || one.above.value < found->above.value)) found = &one;
    }
    return *found;
  };
  for (const bool below : {true, false}) {
    const At nearest = best();
    double step = step_to_sure_sign(nearest, fall);
    for (double wider = 8; !WorkLimit::passed(); step *= wider, wider *= wider) {
      const double open = below ? nearest.t - range.low() : range.high() - nearest.t;
      if (!(open > step)) break;
      if (auto found = at(f, g, below ? nearest.t - step : nearest.t + step, z, W, look))
        take(std::move(*found));
    }
  }
  const At nearest = best();
  Prox made = named(nearest);
  made.error_bound = error_of(nearest);
  return made;
}

}  // namespace

std::optional<Prox> prox_of_two_function_max(const Function& f, const Function& g, const Vector& z,
                                             const Metric& W, const Look& look) {
  return prox_of_two_function_max(f, g, z, W, look, Order::given);
}

}  // namespace convex::inline operations
