#include "convex/operations/two_function_max.hpp"

#include <algorithm>
#include <cmath>

#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"

namespace convex::inline operations {
namespace {

constexpr double least_weight = 1e-30;
constexpr int most_steps = 80;
/// Brackets shorter than this part of t, or of 1 - t, have ended.
constexpr double shortest = 2 * unit_roundoff;

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
  double noise = 0;  ///< of the difference
  Value above;       ///< of the maximum above the mean with these weights
  double size = 0;   ///< of the larger value
};

/// A bracket of the root of a decreasing function on [0, 1]: the chord's root, the value of an end that stays
/// lessened (Anderson and Björck 1973); the middle where two steps did not shorten it to a quarter, or the
/// ends' values are far apart. Middles are of the exponents of t, or of 1 - t, where these are far apart.
class Bracket {
 public:
  Bracket(double low, double high, double of_low, double of_high)
      : low_(low), high_(high), of_low_(of_low), of_high_(of_high) {}

  double next() {
    constexpr double far_apart = 1e3, least_gain = 0.25;
    if (++steps_ % 2 == 0) {
      slow_ = high_ - low_ > least_gain * width_;
      width_ = high_ - low_;
    }
    const double t = low_ + (high_ - low_) * (of_low_ / (of_low_ - of_high_));
    const double ratio = std::abs(of_low_ / of_high_);
    const bool uneven = is_wide() && (ratio > far_apart || ratio < 1 / far_apart);
    const bool plain = !slow_ && !uneven && t > low_ && t < high_;
    slow_ = false;
    return plain ? t : middle();
  }
  /// Another t where nothing is known at this one.
  double beside(double t) const { return t + 0.375 * (high_ - t); }
  void narrow(double t, double value) {
    constexpr double least_part = 0.1;
    const bool is_low = value > 0;
    double &end = is_low ? low_ : high_, &of_end = is_low ? of_low_ : of_high_;
    if (same_side_ == (is_low ? 1 : -1)) {
      const double part = 1 - value / of_end;
      (is_low ? of_high_ : of_low_) *= part > least_part ? part : 0.5;
    }
    same_side_ = is_low ? 1 : -1;
    end = t;
    of_end = value;
  }

 private:
  static constexpr double far = 16;
  bool is_wide() const { return low_ < high_ / far || 1 - high_ < (1 - low_) / far; }
  double middle() const {
    constexpr double most_at_once = 1e-3;
    const double from_one = 1 - high_;
    if (low_ < high_ / far) return std::max(std::sqrt(low_) * std::sqrt(high_), high_ * most_at_once);
    if (from_one < (1 - low_) / far)
      return 1 - std::max(std::sqrt(from_one) * std::sqrt(1 - low_), (1 - low_) * most_at_once);
    return low_ + (high_ - low_) / 2;
  }
  double low_, high_, of_low_, of_high_, width_ = 1;
  int same_side_ = 0, steps_ = 0;
  bool slow_ = false;
};

/// weight · f, a maximum as that of its parts.
Function weighted(const Function& f, double weight) {
  if (weight == 1) return f;
  std::vector<Function> parts = parts_of_max(f);
  if (parts.empty()) return scale(f, weight);
  for (Function& part : parts) part = scale(part, weight);
  return proper_max(std::move(parts));
}

/// (1 - t) f + t g, and the weights.
struct Mean {
  double of_f, of_g;
  Function sum;
};
Mean mean_of(const Function& f, const Function& g, double t) {
  const double of_f = f.facts().finite ? 1 - t : std::max(1 - t, least_weight);
  const double of_g = g.facts().finite ? t : std::max(t, least_weight);
  std::vector<Function> terms;
  if (of_f > 0) terms.push_back(weighted(f, of_f));
  if (of_g > 0) terms.push_back(weighted(g, of_g));
  return {of_f, of_g, proper_sum(terms)};
}

std::optional<At> at(const Function& f, const Function& g, double t, const Vector& z, const Metric& W,
                     const Look& look) {
  const auto [of_f, of_g, mean] = mean_of(f, g, t);
  WorkLimit::count(WorkLimit::of_a_program);
  At found{t, mean, mean.prox(z, W, look), 0, 0, {}, 0};
  if (found.prox.status != Status::solved || found.prox.x.size() != z.size()) return std::nullopt;
  const Value of_g_there = g.evaluate(found.prox.x), of_f_there = f.evaluate(found.prox.x);
  found.difference = of_g_there.value - of_f_there.value;
  found.noise = of_g_there.error + of_f_there.error;
  found.size = std::max(std::abs(of_g_there.value), std::abs(of_f_there.value));
  if (std::isnan(found.difference)) return std::nullopt;
  const double missed = found.difference > 0 ? of_f : -of_g;
  found.above = {missed * found.difference, std::abs(missed) * found.noise};
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
    At alone{0, mean, mean.prox(z, W, look), 0, 0, {}, 0};
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

enum class Order { given, reversed };

std::optional<Prox> prox_of_two_function_max(const Function& f, const Function& g, const Vector& z,
                                             const Metric& W, const Look& look, Order order) {
  std::optional<At> low = near_end(f, g, false, z, W, look);
  // f alone is above g at its prox
  if (low && low->t == 0 && low->difference + low->noise <= 0) return named(*low);
  std::optional<At> high = near_end(f, g, true, z, W, look);
  if (high && high->t == 1 && high->difference - high->noise >= 0) return named(*high);
  if (!low || !high) return std::nullopt;
  double moved_per_difference = 0;  // while the difference of the ends is more than noise
  // Where noise hides the sign at an end the root is there or beyond, as far as is known.
  Bracket bracket{low->t, high->t, std::max(low->difference, low->noise),
                  std::min(high->difference, -high->noise)};
  // The weights that the root is between for sure.
  const auto is_sure = [](const At& found) { return std::abs(found.difference) > found.noise; };
  Vector sure_low = low->prox.x, sure_high = high->prox.x;
  for (int step = 0; step < most_steps && !WorkLimit::passed(); ++step) {
    const double drop = low->difference - high->difference;
    const double apart = W.norm(low->prox.x - high->prox.x);
    if (std::isfinite(drop) && drop > above_noise * (low->noise + high->noise))
      moved_per_difference = apart / drop;
    if (!is_sure(*low) && !is_sure(*high)) break;  // what they say of the root is noise
    if (!(high->t - low->t > shortest * std::min(high->t, 1 - low->t))) break;
    // The weight of f, 1 - t, is known to roundings of 1: the other way round it is t.
    if (1 - low->t < nearly_nothing && order == Order::given)
      return prox_of_two_function_max(g, f, z, W, look, Order::reversed);
    std::optional<At> middle;
    for (double t = bracket.next(); !middle && t > low->t && t < high->t && !WorkLimit::passed();) {
      middle = at(f, g, t, z, W, look);
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
    if (is_sure(*middle)) (middle->difference > 0 ? sure_low : sure_high) = middle->prox.x;
    (middle->difference > 0 ? low : high) = std::move(middle);
  }
  // Both agree but for the distance between them; the nearer one to equality is taken.
  const bool take_low = std::abs(low->difference) <= std::abs(high->difference);
  Prox made = named(take_low ? *low : *high);
  const double open = low->t == high->t ? left(*low) : std::max(low->noise, high->noise);
  made.error_bound =
      std::max(low->prox.error_bound, high->prox.error_bound) + 2 * W.norm(low->prox.x - high->prox.x) +
      (moved_per_difference > 0 ? safety * moved_per_difference * open : 2 * W.norm(sure_low - sure_high));
  return made;
}

}  // namespace

std::optional<Prox> prox_of_two_function_max(const Function& f, const Function& g, const Vector& z,
                                             const Metric& W, const Look& look) {
  return prox_of_two_function_max(f, g, z, W, look, Order::given);
}

namespace {

/// The conjugate of the mean at v, and a point where its supremum is attained.
struct Above {
  double t = 0;
  Value bound;
  Vector x;
  double difference = 0;  ///< g - f there
};

std::optional<Above> above(const Function& f, const Function& g, double t, const Vector& v) {
  WorkLimit::count(WorkLimit::of_a_program);
  const Function conjugate = mean_of(f, g, t).sum.conjugate();
  const std::optional<Vector> x = conjugate.subgradient(v);
  if (!x || x->size() != v.size() || !x->allFinite()) return std::nullopt;
  const Above found{t, conjugate.evaluate(v), *x, g(*x) - f(*x)};
  return std::isnan(found.difference) ? std::nullopt : std::optional(found);
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
  Bracket bracket{0, 1, low->difference, high->difference};
  for (int step = 0; step < most_steps && !WorkLimit::passed(); ++step) {
    const bool is_open = low->difference > 0 && high->difference < 0;
    if (!is_open || !(least + error - most > enough * std::abs(least))) break;
    if (!(high->t - low->t > shortest * std::min(high->t, 1 - low->t))) break;
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
