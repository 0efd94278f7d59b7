#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/motion/motion.hpp"

namespace cli {

/// Instants of a motion, one after the other: evenly spaced with both ends among them, or `begin` and all
/// that follow by a period.
class Instants {
 public:
  static Instants evenly(double begin, double end, long count) { return {begin, end, count, 0}; }
  static Instants strobe(double begin, double end, double period);
  long count() const { return count_; }
  double operator[](long k) const;

 private:
  Instants(double begin, double end, long count, double period)
      : begin_(begin), end_(end), period_(period), count_(count) {}
  double begin_, end_, period_;
  long count_;
};

/// Coordinates that turn, brought to 0 <= q < modulo where that is not 0: n, or empty.
convex::Vector wrapped(convex::Vector q, const convex::Vector& modulo);

/// The trajectory as a table (docs/motion.md): rows of t, q, q', q'', the multipliers and T + V at some
/// instants. A row at an event holds the state after it.
class TrajectoryFile {
 public:
  /// modulo: of `wrapped`. Throws InvalidInput when the file cannot be written.
  TrajectoryFile(const std::string& path, const mechanics::LagrangianSystem& system, Instants instants,
                 convex::Vector modulo = {});
  /// The rows before the present time of the motion, from its last step.
  void follow(const mechanics::Motion& motion);
  /// The row of the present state, if one is due, at the end of the motion.
  void finish(const mechanics::Motion& motion);

 private:
  void write(const mechanics::State& state, const convex::Vector& q2, const convex::Vector& lambda);

  std::ofstream file_;
  std::string path_;
  const mechanics::LagrangianSystem& system_;
  Instants instants_;
  convex::Vector modulo_;
  long row_ = 0;
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

/// A heading of a CSV column: in quotation marks where it has a comma.
std::string column_heading(const std::string& name);

/// A file to be written; throws InvalidInput when it cannot be opened.
std::ofstream opened(const std::string& path);
/// Closes it; throws InvalidInput when something could not be written.
void require_written(std::ofstream& file, const std::string& path);

/// The names of constraints, in order.
std::vector<std::string> constraint_names(const mechanics::System& system);

}  // namespace cli
