#include "convex/operations/weight_range.hpp"

#include <algorithm>
#include <cmath>

#include "convex/vector.hpp"

namespace convex::inline operations {

void WeightRange::learn(const ProxOfMean& found) {
  const double sure = std::abs(found.difference) - found.noise;
  if (!(sure > 0)) return;
  const double missed = found.error / 2;
  const double open = found.rounding + missed * (missed / sure);
  if (found.difference > 0)
    low_ = std::max(low_, found.t - open);
  else
    high_ = std::min(high_, found.t + open);
}

double WeightRange::error_of(const ProxOfMean& found) const {
  const auto part = [&](double difference, double width) {
    return std::max(difference + found.noise, 0.0) * (std::max(width, 0.0) + found.rounding);
  };
  const double open =
      std::max(part(found.difference, high_ - found.t), part(-found.difference, found.t - low_));
  const double half = found.error / 2;
  return half + std::hypot(half, std::sqrt(open));
}

}  // namespace convex::inline operations
