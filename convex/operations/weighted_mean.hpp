#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// What a function that is not finite everywhere keeps of a weight of 0, and with it its domain.
inline constexpr double least_weight = 1e-30;
/// In a search for a weight, its steps at the most; and brackets shorter than this part of t, or of 1 - t,
/// have ended.
inline constexpr int most_weights = 80;
inline constexpr double shortest_bracket = 2 * unit_roundoff;

/// weight · f, a maximum as that of its parts.
Function weighted(const Function& f, double weight);

/// (1 - t) f + t g, and the weights.
struct WeightedMean {
  double of_f, of_g;
  Function sum;
};
enum class TermOrder { given, turned };
WeightedMean weighted_mean(const Function& f, const Function& g, double t,
                           TermOrder order = TermOrder::given);

}  // namespace convex::inline operations
