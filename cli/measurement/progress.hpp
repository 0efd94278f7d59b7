#pragma once

#include <chrono>
#include <string>

namespace cli::inline measurement {

/// A bar on standard error with the time left, where that is a terminal; and whether Ctrl-C was pressed, upon
/// which a measurement ends with what it has.
class Progress {
 public:
  explicit Progress(int steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is being done, within the step.
  void now(const std::string& what);
  /// A step is done.
  void step();
  static bool interrupted();

 private:
  void show() const;
  int steps_, done_ = 0;
  bool shown_;
  std::string what_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace cli::inline measurement
