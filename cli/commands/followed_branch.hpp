#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands/branch_event.hpp"
#include "cli/commands/branch_range.hpp"
#include "cli/commands/orbit_branch.hpp"
#include "cli/drawing/branch_drawing.hpp"
#include "mechanics/motion/turning_point.hpp"

namespace cli::inline commands {

/// A branch of orbits over a parameter, followed with the values at which something happens on it.
///
/// Its orbits are followed by the map from an instant of the period at which nothing happens, which moves on
/// before an event comes near it; they are told at the time of the file's state.
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
  long count() const { return count_; }
  /// What the table has no word for.
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  /// An orbit of the branch, at a value of the parameter.
  struct Station {
    double value = 0;
    mechanics::Orbit orbit;
  };
  /// An orbit at which something happens, and one just behind it.
  struct Passage {
    Station at, behind;
  };
  std::optional<Station> attempt(double value, const mechanics::State& guess, double period);
  /// Between, or beyond, two orbits.
  std::optional<Station> attempt_along(const Station& a, const Station& b, double value);
  /// From the polynomial through the last orbits of several: nearer than a line where Newton's method has
  /// little room, as beside a graze, where a multiplier grows without bound.
  std::optional<Station> attempt_by_polynomial(const std::vector<Station>& through, double value);

  mechanics::OrbitFamily family() const;
  mechanics::OrbitQuestion question(const mechanics::LagrangianSystem&, double value) const;

  /// The same orbit by the map from another instant.
  Station moved(const Station&, double t) const;
  /// Moves the instant of the map where an event has come near it.
  void choose_instant();

  /// Whether an orbit is where the last two lead; if not, Newton's method went to another branch.
  bool follows(const Station& next) const;

  /// Whether its impacts are those of the last one, or a graze lies between them: near a graze orbits of two
  /// branches, with the impact and without it, are so near to each other that only this tells them apart.
  bool has_its_impacts(const Station& next);

  /// The orbit at a value from the last ones, with shorter steps between where these lead elsewhere.
  std::optional<Station> attempt_from_last(double value, int depth = 0);
  static constexpr int deepest = 8;

  /// After how many of the periods asked for an orbit comes back.
  long periods_of(const Station&) const;

  void row(const Station& at, BranchEvent event);

  /// The first orbit, which may be a fold itself.
  void begin(const Station& first);

  /// The next orbit, and before it those at which something happens on the way, each in a row of its own.
  void arrive(const Station& next);

  /// The first event between two orbits; `none` where a multiplier leaps.
  std::optional<Passage> locate(Station a, Station b, BranchEvent& event);
  /// An orbit a little behind one at which something happens.
  Passage behind(const Station& at, const Station& before, const Station& after, BranchEvent event);
  /// The contact of which one of them has more impacts, or -1.
  static convex::Index grazed(const Station& a, const Station& b);
  /// Where the gap, or the speed of the impact, of a contact comes to 0 behind two orbits, before `beyond`;
  /// of an opening, its multiplier.
  std::optional<Station> locate_grazing(const Station& a, const Station& b, double beyond, convex::Index,
                                        BranchEvent event = BranchEvent::grazing);

  /// The graze at which the impacts of a contact end, from orbits that lack them beside the value to which
  /// its speed leads: Newton's method finds these however near, and those with the impact only from nearby.
  std::optional<Station> locate_from_behind(convex::Index contact);

  /// The last orbit that is found before a value, and the next value at which none is.
  std::pair<Station, double> approach(double beyond);

  /// Whether the branch turns around before a value at which it has no orbit. If so, the fold is told, and
  /// `fold_` is what finds orbits behind it.
  bool turn(double beyond);
  /// Whether it ends there as a contact is grazed. If so, that is told, and it goes on with the orbits that
  /// have the impact, or are without it, where there are any, `is_on`.
  bool graze(double beyond, bool& is_on);
  /// `impacts`: those of the orbits before.
  bool begin_behind_grazing(const Station& at, std::size_t impacts);

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
  double t_ = 0;                 // of the file's state
  std::optional<Station> last_;  // in the table
  std::vector<Station> trail_;   // the last few, those between values of the range too
  long count_ = 0;
  /// Of the orbits sought since the last row, how often they fly from impact to impact; folds and grazes that
  /// are found take 2,000. Beyond so many the branch ends.
  static constexpr std::size_t most_flown = 10'000;
  std::size_t flown_ = 0;
  std::string table_, why_;
  std::vector<BranchPoint> points_;
  std::vector<std::string> remarks_;
  bool is_lost_ = false;                         // Newton's method went to another branch
  int forward_ = 1;                              // -1 behind a fold
  std::optional<mechanics::TurningPoint> fold_;  // the last one
};

}  // namespace cli::inline commands
