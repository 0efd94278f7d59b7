#include "mechanics/motion/accumulation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

namespace mechanics::inline motions {

void ImpactHistory::add(double since, double speed, double t, double noise, double speed_noise) {
  interval_[2] = interval_[1];
  interval_[1] = interval_[0];
  interval_[0] = since;
  speed_before_ = speed_;
  speed_ = speed;
  highest_ = std::max(highest_, 0.5 * speed * since);  // a fall from rest, or a bounce
  noise_ += noise;
  speed_noise_ += speed_noise;
  ++count_;
  if (std::has_single_bit(static_cast<unsigned long>(count_))) {
    std::copy_backward(mark_, mark_ + 3, mark_ + 4);
    std::copy_backward(mark_speed_, mark_speed_ + 3, mark_speed_ + 4);
    mark_[0] = t;
    mark_speed_[0] = speed;
  }
  shrinking_ = shrinks() ? shrinking_ + 1 : 0;
  if (shrinking_ == 0) {
    if (t > end_ + end_error_) end_error_ = std::numeric_limits<double>::infinity();
    return;
  }
  // The ratios to come. Their drift shrinks as the intervals do, by r each, so that it adds up to this at
  // most.
  const double r = ratio(), before = interval_[1] / interval_[2];
  const double uncertain = 2 * noise / interval_[0];
  const double highest = r + std::abs(r - before) * r / (1 - r) + uncertain;
  const double end = t + remaining();
  // An impact that is late by τ falls τ times the acceleration g too fast, from where f is -τ times the
  // speed: the bounces to come keep the excess, and the end moves by (1 + 1/r) τ. What a speed is off by, all
  // later intervals are multiples of: the end moves by as much of what remained then, which is to what
  // remains now as the speeds are.
  const double by_rounding = (1 + 1 / r) * noise_ + remaining() / speed_ * speed_noise_;
  const double error = highest < 1 ? interval_[0] * (highest / (1 - highest) - r / (1 - r)) + by_rounding
                                   : std::numeric_limits<double>::infinity();
  if (error > end_error_ && std::abs(end - end_) <= error + end_error_) return;
  end_ = end;
  end_error_ = error;
}

std::optional<double> ImpactHistory::end_of_gain() const {
  constexpr long fewest_marked = 8;  // four marks
  // The gap has shrunk a thousand times by one law; after a hundred thousand impacts by about one.
  const double by_one_law = count_ < (1L << 17) ? 1e-3 : 0.1;
  if (count_ < fewest_marked || !std::has_single_bit(static_cast<unsigned long>(count_))) return std::nullopt;
  if (!std::is_sorted(mark_speed_, mark_speed_ + 4, std::greater<>())) return std::nullopt;
  const double last = mark_[0] - mark_[1];
  const double r = last / (mark_[1] - mark_[2]), before = (mark_[1] - mark_[2]) / (mark_[2] - mark_[3]);
  if (!(r < 1) || !(std::abs(r - before) <= by_one_law * (1 - r))) return std::nullopt;
  const double highest = r + std::abs(r - before) * r / (1 - r);
  if (!(highest < 1)) return std::nullopt;
  return mark_[0] + last * highest / (1 - highest);
}

bool ImpactHistory::shrinks() const {
  constexpr double steady = 0.1;  // of what is missing to 1
  if (count_ < fewest || !(interval_[0] < interval_[1]) || !(interval_[1] < interval_[2])) return false;
  const double last = interval_[0] / interval_[1], before = interval_[1] / interval_[2];
  return std::abs(last - before) <= steady * (1 - last);
}

double ImpactHistory::remaining() const {
  const double r = ratio();
  return interval_[0] * r / (1 - r);
}

}  // namespace mechanics::inline motions
