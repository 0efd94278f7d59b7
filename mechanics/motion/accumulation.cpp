#include "mechanics/motion/accumulation.hpp"

#include <cmath>

namespace mechanics {

void ImpactHistory::add(double since, double speed, double t, double noise) {
  interval_[2] = interval_[1];
  interval_[1] = interval_[0];
  interval_[0] = since;
  speed_ = speed;
  ++count_;
  if (!shrinks()) {
    if (t > end_ + end_error_) end_error_ = std::numeric_limits<double>::infinity();
    return;
  }
  // The end t + Δ r / (1 - r), Δ and r uncertain.
  const double r = ratio(), before = interval_[1] / interval_[2];
  const double error = (interval_[0] * std::abs(r - before) + 2 * noise) / ((1 - r) * (1 - r));
  const double end = t + remaining();
  if (error > end_error_ && std::abs(end - end_) <= error + end_error_) return;
  end_ = end;
  end_error_ = error;
}

bool ImpactHistory::shrinks() const {
  constexpr long fewest = 4;      // three intervals, two ratios
  constexpr double steady = 0.1;  // of what is missing to 1
  if (count_ < fewest || !(interval_[0] < interval_[1]) || !(interval_[1] < interval_[2])) return false;
  const double last = interval_[0] / interval_[1], before = interval_[1] / interval_[2];
  return std::abs(last - before) <= steady * (1 - last);
}

double ImpactHistory::remaining() const {
  const double r = ratio();
  return interval_[0] * r / (1 - r);
}

}  // namespace mechanics
