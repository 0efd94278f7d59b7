#pragma once

#include <chrono>
#include <string>

namespace cli {

/// A bar on standard error with the time left, where that is a terminal; and whether Ctrl-C was pressed, upon
/// which a measurement ends with what it has.
class Progress {
 public:
  explicit Progress(int steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step(const std::string& what);
  static bool interrupted();

 private:
  int steps_, done_ = 0;
  bool shown_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace cli
