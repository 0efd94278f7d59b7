#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "convex/vector.hpp"

namespace mechanics::inline motions {

using convex::Index;

/// The last impacts of a contact, and what they lead to: intervals that shrink by a steady ratio r < 1 come
/// to an end at a time that their sum gives, Δ r / (1 - r) after the last one (Zeno).
class ImpactHistory {
 public:
  /// An impact at the time `since` after the last one (differences of times would lose digits), with the
  /// speed -df/dt before it.
  /// t: when; noise, speed_noise: how far `since` and the speed may be off by rounding.
  void add(double since, double speed, double t, double noise, double speed_noise);
  /// After the end. What is rounding once is so when another contact strikes.
  void forget() {
    const double of_rounding = of_rounding_;
    *this = ImpactHistory();
    of_rounding_ = of_rounding;
  }
  /// Of the bounce that this impact ends, how high it was, in bounces so low that rounding decides when f
  /// comes to 0. One that is n times as high counts as a part 1/n: it may be what others have left, that
  /// rest.
  void note_bounce(double times_rounding) {
    constexpr double highest_told = 256;
    of_rounding_ = times_rounding <= highest_told ? of_rounding_ + 1 / std::max(1.0, times_rounding) : 0;
  }
  /// Whether the last bounces were so, as many of them as tell a ratio: where they told none before, as of
  /// contacts that strike in turn, one of them once and another one twice, rounding is all that goes on.
  bool is_rounding() const { return of_rounding_ >= fewest; }

  /// The next impact may come so much sooner or later, and so much faster or slower, than is told.
  void doubt(double time, double speed) {
    noise_ += time;
    speed_noise_ += speed;
  }

  /// How many intervals one after the other have shrunk by a steady ratio so far.
  long shrinking() const { return shrinking_; }
  /// Whether the impacts lose their speed as well, so that rest follows: a body between walls that close in
  /// on it strikes ever faster.
  bool slows() const { return speed_ < speed_before_; }
  /// The latest end of impacts that gain speed without bound, as of a body between walls that close in on it,
  /// told by every impact number 2^k. With intervals that shrink as a power of the time left, the time from
  /// one of these to the next shrinks by a steady ratio. Nothing where it does not, or at another impact.
  std::optional<double> end_of_gain() const;
  long count() const { return count_; }
  /// Whether the last three intervals shrink by one ratio.
  bool shrinks() const;
  double ratio() const { return interval_[0] / interval_[1]; }
  /// The time from the last impact to the end.
  double remaining() const;
  /// When it ends, and how far that may be off: the tail Δ r / (1 - r) with r enclosed by what its drift,
  /// which shrinks as the intervals do, adds up to, and by the rounding of all impacts so far. Of all that
  /// the impacts told the surest: the last bounces may be so low that rounding of f decides them.
  double end() const { return end_; }
  double end_error() const { return end_error_; }
  /// A bound on how high, in units of f, the next bounce goes.
  double next_height() const { return 0.25 * speed_ * interval_[0]; }
  /// A bound on the highest f so far: what is far below it has no part in the motion any more, whatever the
  /// unit.
  double highest() const { return highest_; }

 private:
  static constexpr long fewest = 4;  // impacts, of which three intervals and two ratios tell
  long count_ = 0, shrinking_ = 0;
  double of_rounding_ = 0;
  double interval_[3] = {0, 0, 0};  // the last one first
  double speed_ = 0, speed_before_ = 0, highest_ = 0;
  double noise_ = 0, speed_noise_ = 0;                            // of all impacts so far
  double mark_[4] = {0, 0, 0, 0}, mark_speed_[4] = {0, 0, 0, 0};  // at impact 2^k, the last one first
  double end_ = 0, end_error_ = std::numeric_limits<double>::infinity();
};

}  // namespace mechanics::inline motions
