#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/motion/motion.hpp"

namespace cli {

/// The trajectory as a table (docs/motion.md): evenly spaced rows of t, q, q', q'', the multipliers and T +
/// V. A row at an event holds the state after it.
class TrajectoryFile {
 public:
  /// Throws InvalidInput when the file cannot be written.
  TrajectoryFile(const std::string& path, const mechanics::LagrangianSystem& system, double begin, double end,
                 long samples);
  /// The rows before the present time of the motion, from its last step.
  void follow(const mechanics::Motion& motion);
  /// The row of the present state, if one is due, at the end of the motion.
  void finish(const mechanics::Motion& motion);

 private:
  double time(long row) const;
  void write(const mechanics::State& state, const convex::Vector& q2, const convex::Vector& lambda);

  std::ofstream file_;
  std::string path_;
  const mechanics::LagrangianSystem& system_;
  double begin_, end_;
  long samples_, row_ = 0;
};

/// The events, one JSON object a line.
class EventsFile {
 public:
  EventsFile(const std::string& path, const mechanics::LagrangianSystem& system);
  void write(const mechanics::MotionEvent& event);
  void finish();

 private:
  std::ofstream file_;
  std::string path_;
  std::vector<std::string> coordinates_, constraints_;
};

/// The names of constraints, in order.
std::vector<std::string> constraint_names(const mechanics::System& system);

}  // namespace cli
