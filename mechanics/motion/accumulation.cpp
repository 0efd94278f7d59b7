#include "mechanics/motion/accumulation.hpp"

#include <cmath>

namespace mechanics {

void ImpactHistory::add(double since, double speed) {
  interval_[2] = interval_[1];
  interval_[1] = interval_[0];
  interval_[0] = since;
  speed_ = speed;
  ++count_;
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

double ImpactHistory::remaining_error() const {
  const double last = ratio(), before = interval_[1] / interval_[2];
  return remaining() * std::abs(last - before) / ((1 - last) * (1 - last));
}

}  // namespace mechanics
