#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands/branch_range.hpp"
#include "cli/commands/orbit_branch.hpp"
#include "cli/drawing/branch_drawing.hpp"
#include "mechanics/motion/turning_point.hpp"

namespace cli::inline commands {

/// A branch of orbits over a parameter, followed with the values at which something happens on it.
class FollowedBranch {
 public:
  FollowedBranch(const Problem& problem, const mechanics::OrbitQuestion& asked, const OrbitOptions& options,
                 BranchRange range)
      : problem_(problem), asked_(asked), options_(options), range_(std::move(range)) {}

  /// Why it ends before the range does, or nothing.
  std::string follow();
  /// Rows of the table, without its head.
  const std::string& table() const { return table_; }
  const std::vector<BranchPoint>& points() const { return points_; }
  long count() const { return static_cast<long>(stations_.size()); }

 private:
  /// An orbit of the branch, at a value of the parameter.
  struct Station {
    double value = 0;
    mechanics::Orbit orbit;
  };
  std::optional<Station> attempt(double value, const mechanics::State& guess, double period);

  mechanics::OrbitFamily family() const;

  /// Whether an orbit is where the last two lead; if not, Newton's method went to another branch.
  bool follows(const Station& next) const;

  /// The orbit at a value from the last ones, with shorter steps between where these lead elsewhere.
  std::optional<Station> attempt_from_last(double value, int depth = 0);

  void row(const Station& at, const std::string& event);

  /// The first orbit, which may be a fold itself.
  void begin(const Station& first);

  /// The next orbit, and before it those at which something happens on the way, each in a row of its own.
  void arrive(const Station& next);

  /// The orbit just past an event between two, by bisection; `event` is the first one.
  std::optional<Station> locate(Station a, Station b, std::string& event);

  /// The last orbit that is found before a value, and the next value at which none is.
  std::pair<Station, double> approach(double beyond);

  /// Whether an impact passes the time of the start before a value. If so, the branch goes on from the orbit
  /// just behind that, whose start is on the other side of the impact.
  bool across_start(double beyond);

  /// Whether the branch turns around before a value at which it has no orbit. If so, the fold is told, and
  /// `fold_` is what finds orbits behind it.
  bool turn(double beyond);

  /// How far `to` is from `from` in the direction of the branch at the fold.
  double along(const mechanics::State& from, const mechanics::State& to) const;

  /// Two orbits on the other side of the fold, so near it that the branch is nearly a parabola, and no
  /// further than `value`.
  bool begin_behind_fold(double value);

  /// In which direction the parameter goes.
  double way() const { return range_.step > 0 ? forward_ : -forward_; }

  const Problem& problem_;
  const mechanics::OrbitQuestion& asked_;
  const OrbitOptions& options_;
  BranchRange range_;
  std::vector<Station> stations_;  // in the table
  std::vector<Station> trail_;     // the last two, those between values of the range too
  std::string table_, why_;
  std::vector<BranchPoint> points_;
  bool is_lost_ = false;                         // Newton's method went to another branch
  int forward_ = 1;                              // -1 behind a fold
  std::optional<mechanics::TurningPoint> fold_;  // the last one
};

}  // namespace cli::inline commands
