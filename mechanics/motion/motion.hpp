#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/contacts.hpp"
#include "mechanics/lagrangian_system.hpp"
#include "mechanics/motion/arc.hpp"
#include "mechanics/motion/impact.hpp"

namespace mechanics::inline motions {

/// How a motion is followed: from event to event, or in steps of one length that do not look for events.
enum class MotionMethod { event_driven, time_stepping };
const char* name(MotionMethod);

/// How to follow a motion.
struct MotionOptions {
  MotionMethod method = MotionMethod::event_driven;
  /// Estimated error of a step, relative to what the system moves in it. Loosen it for speed.
  double tolerance = 1e-10;
  Vector restitution;  ///< e_a, one a constraint, 0 <= e_a <= 1; empty: all 0
  ImpactLaw impact_law = ImpactLaw::moreau;
  double step = 1e-3;        ///< of time-stepping
  double theta = 0.5;        ///< of time-stepping: where in a step forces are taken, 1/2 to 1
  Vector contact_tolerance;  ///< of the state at the start, as of `contacts`; empty: the default
  long step_limit = 10'000'000;
};

/// What happens at an instant.
enum class EventKind { impact, contact, release, accumulation, branch };
const char* name(EventKind);

struct MotionEvent {
  double t = 0;
  EventKind kind = EventKind::impact;
  std::vector<Index> constraints;  ///< those that close, open or come to rest; none for a branch
  Vector velocity_before, velocity_after;
};

enum class MotionStatus { done, stopped, infeasible };

/// What a remark is about.
enum class RemarkKind {
  start,         ///< a contact counts as closed at the start
  touch,         ///< one is touched and left within rounding
  slow_closing,  ///< the rounding of f leaves the time of an impact open
  speed,         ///< a contact closes with a speed that rounding may have made
  order,         ///< impacts that rounding does not tell apart
  impact_law,    ///< what the data leave open of an impact
  accumulation,  ///< impacts not followed one by one
  doubt,         ///< whether a contact stays
  step,          ///< the velocity of a step of time-stepping
  correction,    ///< positions of time-stepping that are not brought back
  growth         ///< what a rounding at the start has become
};

/// Where accuracy was lost, or a decision was not determined: when, and what. One remark a kind; of several,
/// that of which most was lost, or the first.
struct MotionRemark {
  RemarkKind kind;
  double t = 0;  ///< the first time
  std::string what;
  long count = 1;
  double last = t;  ///< the last time
  double loss = 0;  ///< in its own unit; 0 where it has none
};

/// An impact before it is decided: what a law of impact needs.
struct ImpactScene {
  double t = 0;
  convex::Metric A;
  Vector velocity;
  double kinetic = 0;  ///< T before
  Vector b;            ///< ∂T/∂q' - A q'
  std::vector<Index> constraints;
  std::vector<ImpactContact> contacts;
};

/// Counts and figures of the motion so far.
struct MotionRecord {
  long steps = 0, events = 0, impacts = 0;
  double largest_penetration = 0;  ///< largest -f_a over its scale
  Index most_penetrated = -1;      ///< its constraint
  double impact_energy = 0;        ///< Σ T+ - T- over the impacts, as T gives it
  double ledger_energy = 0;        ///< the same by Σ P_a ((1 - e_a)/2 f'_a(v-) - ∂f_a/∂t) + b·(v+ - v-)
  double corrected_penetration = 0;   ///< time-stepping: the largest one that the position was corrected by
  double correction_energy = 0;       ///< time-stepping: Σ change of T + V by these corrections
  std::vector<MotionRemark> remarks;  ///< one a kind
  std::optional<ImpactScene> first_impact;
};

/// The motion of a mechanical system with one-sided frictionless constraints: smooth arcs by Taylor series,
/// events, impacts, accumulations of impacts, rest on contacts (docs/motion.md).
///
///   Motion motion(system, state, {.restitution = e});
///   while (motion.advance(3.0)) use(motion.arc(), motion.events());
class Motion {
 public:
  /// `system` must outlive the motion. Throws InvalidInput for e outside [0, 1], and where the state cannot
  /// begin a motion: penetration, or two-sided constraints that do not hold.
  Motion(const LagrangianSystem& system, const State& state, MotionOptions options = {});
  ~Motion();
  Motion(Motion&&) noexcept;

  /// Goes on by one step, at most to `until`; false when nothing is left to do: `until` is reached, or
  /// status() is not `done`.
  bool advance(double until);
  /// Goes on from here in steps of time-stepping, as long as the options say; the record goes on too. For a
  /// motion whose events crowd. Throws InvalidInput where time-stepping does not have the law of impact.
  void go_on_in_steps();

  /// The last step as a function of time; its end is the state before the events there.
  const Arc& arc() const;
  /// The events at the end of the last step (or at the very start).
  const std::vector<MotionEvent>& events() const;
  /// The state now, after events.
  const State& state() const;
  /// Right limits at this state: q'' and the multipliers of all constraints; empty where the motion has none.
  const Vector& acceleration() const;
  const Vector& multipliers() const;
  /// T + V; infinite where it is no double, as of a fall into a pole.
  double energy() const;

  MotionMethod method() const;
  MotionStatus status() const;
  /// Why the motion was stopped, or which constraints exclude each other.
  const std::string& why() const;
  const std::vector<Index>& excluding() const;
  const MotionRecord& record() const;

 private:
  class Course;
  class EventDriven;
  class NotBegun;
  class TimeStepping;
  std::unique_ptr<Course> course_;
};

}  // namespace mechanics::inline motions
