#include "convex/operations/weighted_mean.hpp"

#include <algorithm>

#include "convex/operations/operations.hpp"
#include "convex/operations/sum.hpp"
#include "convex/operations/two_function_max.hpp"

namespace convex::inline operations {

Function weighted(const Function& f, double weight) {
  if (weight == 1) return f;
  std::vector<Function> parts = parts_of_max(f);
  if (parts.empty()) return scale(f, weight);
  for (Function& part : parts) part = scale(part, weight);
  return proper_max(std::move(parts));
}

WeightedMean weighted_mean(const Function& f, const Function& g, double t, TermOrder order) {
  const double of_f = f.facts().finite ? 1 - t : std::max(1 - t, least_weight);
  const double of_g = g.facts().finite ? t : std::max(t, least_weight);
  std::vector<Function> terms;
  if (of_f > 0) terms.push_back(weighted(f, of_f));
  if (of_g > 0) terms.push_back(weighted(g, of_g));
  if (order == TermOrder::turned) std::reverse(terms.begin(), terms.end());
  return {of_f, of_g, proper_sum(terms)};
}

}  // namespace convex::inline operations
