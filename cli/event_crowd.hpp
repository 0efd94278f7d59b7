#pragma once

#include <string>

#include "mechanics/motion/motion.hpp"

namespace cli {

/// Whether the events of a motion come so closely that following each may not end: as in a pile that comes to
/// rest, where the ends of infinitely many impacts are infinitely many themselves. Counts alone decide, so
/// that the same file gives the same motion.
class EventCrowd {
 public:
  /// step: of time-stepping, which could go on instead.
  EventCrowd(double begin, double until, double step) : since_(begin), length_(until - begin), step_(step) {}

  /// After each step; true once: a thousand events have come within a thousandth of the motion, and within no
  /// more than a thousand steps.
  bool has_come(const mechanics::Motion& motion);
  /// "1000 events have come within 2e-05 at t = 0.8".
  const std::string& what() const { return what_; }

 private:
  double since_, length_, step_;
  long counted_ = 0;
  std::string what_;
};

}  // namespace cli
