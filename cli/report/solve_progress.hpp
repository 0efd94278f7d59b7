#pragma once

#include <chrono>
#include <string_view>

#include "convex/nearest_point/solve_watch.hpp"

namespace cli::inline reports {

/// A line on standard error for a solve that lasts over a second, where that is a terminal: the method, its
/// steps and the time so far. It goes when the solve is over. Ctrl-C takes it away, tells that the solve was
/// interrupted, and ends the program as the signal does.
class SolveProgress {
 public:
  SolveProgress();
  ~SolveProgress();
  SolveProgress(const SolveProgress&) = delete;
  SolveProgress& operator=(const SolveProgress&) = delete;

 private:
  void show(std::string_view method, convex::Index steps);

  bool terminal_, shown_ = false;
  void (*interrupted_before_)(int);
  std::chrono::steady_clock::time_point start_, last_;
  convex::SolveWatch watch_;
};

}  // namespace cli::inline reports
