#pragma once

#include <chrono>

#include "mechanics/motion/motion.hpp"

namespace cli::inline reports {

/// A line on standard error for a motion that lasts over a second, where that is a terminal: the simulated
/// time, steps and events so far. It goes when the motion is over.
class MotionProgress {
 public:
  MotionProgress(double begin, double end);
  ~MotionProgress();
  MotionProgress(const MotionProgress&) = delete;
  MotionProgress& operator=(const MotionProgress&) = delete;
  void tell(const mechanics::Motion&);

 private:
  double begin_, end_;
  bool terminal_, shown_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace cli::inline reports
