#include "convex/operations/two_function_max.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/work_limit.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"

namespace convex::inline operations {
namespace {

constexpr double least_weight = 1e-30;
constexpr int most_halvings = 80;
/// Brackets shorter than this part of t, or of 1 - t, have ended.
constexpr double shortest = 2 * unit_roundoff;

/// A drop of g - f says how x follows it where it is so much more than noise.
constexpr double above_noise = 1e3, safety = 4;

/// The prox at a weight, and g - f there.
struct At {
  double t = 0;
  Function mean;
  Prox prox;
  double difference = 0;
  double noise = 0;  ///< of the difference
  Value above;       ///< of the maximum above the mean with these weights
};

/// weight · f, a maximum as that of its parts.
Function weighted(const Function& f, double weight) {
  if (weight == 1) return f;
  std::vector<Function> parts = parts_of_max(f);
  if (parts.empty()) return scale(f, weight);
  for (Function& part : parts) part = scale(part, weight);
  return proper_max(std::move(parts));
}

std::optional<At> at(const Function& f, const Function& g, double t, const Vector& z, const Metric& W,
                     const Look& look) {
  const double of_f = f.facts().finite ? 1 - t : std::max(1 - t, least_weight);
  const double of_g = g.facts().finite ? t : std::max(t, least_weight);
  std::vector<Function> terms;
  if (of_f > 0) terms.push_back(weighted(f, of_f));
  if (of_g > 0) terms.push_back(weighted(g, of_g));
  const Function mean = proper_sum(terms);
  At found{t, mean, mean.prox(z, W, look), 0, 0, {}};
  if (found.prox.status != Status::solved || found.prox.x.size() != z.size()) return std::nullopt;
  const Value of_g_there = g.evaluate(found.prox.x), of_f_there = f.evaluate(found.prox.x);
  found.difference = of_g_there.value - of_f_there.value;
  found.noise = of_g_there.error + of_f_there.error;
  if (std::isnan(found.difference)) return std::nullopt;
  const double missed = found.difference > 0 ? of_f : -of_g;
  found.above = {missed * found.difference, std::abs(missed) * found.noise};
  return found;
}

/// The conjugate of the maximum is at most that of a mean, and the maximum is so much more than the mean.
Prox named(const At& at_weight) {
  Prox made = at_weight.prox;
  const Function& mean = at_weight.mean;
  if (!made.values && mean.facts().piecewise_quadratic)
    made.values = {mean.evaluate(made.x), mean.conjugate().evaluate(made.v), 0};
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
    At alone{0, mean, mean.prox(z, W, look), 0, 0, {}};
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

std::optional<Prox> prox_of_two_function_max(const Function& f, const Function& g, const Vector& z,
                                             const Metric& W, const Look& look) {
  std::optional<At> low = at(f, g, 0, z, W, look);
  if (low && low->difference <= 0) return named(*low);  // f alone is above g at its prox
  std::optional<At> high = at(f, g, 1, z, W, look);
  if (high && high->difference >= 0) return named(*high);
  if (!low || !high) return std::nullopt;
  double moved_per_difference = 0;  // while the difference of the ends is more than noise
  double low_value = low->difference, high_value = high->difference;
  for (int step = 0; step < most_halvings && !WorkLimit::passed(); ++step) {
    const double width = high->t - low->t, drop = low->difference - high->difference;
    if (std::isfinite(drop) && drop > above_noise * (low->noise + high->noise))
      moved_per_difference = W.norm(low->prox.x - high->prox.x) / drop;
    if (!(width > shortest * std::min(high->t, 1 - low->t))) break;
    // The Illinois method; every third step halves, in the exponent where the ends are far apart.
    double t = low->t + width * (low_value / (low_value - high_value));
    if (step % 3 == 2 || !(t > low->t && t < high->t)) {
      t = low->t + width / 2;
      if (low->t < high->t / 16) t = std::max(std::sqrt(low->t) * std::sqrt(high->t), high->t * 1e-3);
      const double from_one = 1 - high->t;
      if (from_one < (1 - low->t) / 16)
        t = 1 - std::max(std::sqrt(from_one) * std::sqrt(1 - low->t), (1 - low->t) * 1e-3);
    }
    if (!(t > low->t && t < high->t)) break;
    auto middle = at(f, g, t, z, W, look);
    if (!middle) return std::nullopt;
    const double value = middle->difference;
    if (value == 0) {
      low = high = middle;
      break;
    }
    const bool below = value > 0;
    (below ? high_value : low_value) *= 0.5;
    (below ? low_value : high_value) = value;
    (below ? low : high) = std::move(middle);
  }
  // Both agree but for the distance between them; the nearer one to equality is taken.
  const bool take_low = std::abs(low->difference) <= std::abs(high->difference);
  Prox made = named(take_low ? *low : *high);
  made.error_bound = std::max(low->prox.error_bound, high->prox.error_bound) +
                     2 * W.norm(low->prox.x - high->prox.x) +
                     safety * moved_per_difference * std::max(low->noise, high->noise);
  return made;
}

}  // namespace convex::inline operations
