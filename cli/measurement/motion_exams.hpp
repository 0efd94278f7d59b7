#pragma once

#include "cli/measurement/contest.hpp"
#include "mechanics/lagrangian_text.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli::inline measurement {

/// What is left of a motion for its judge.
struct MotionOutcome {
  mechanics::MotionStatus status = mechanics::MotionStatus::stopped;
  mechanics::State end;
  double energy = 0;
  mechanics::MotionRecord record;
  double accumulation = 0;  ///< when the first one ended; 0: none
};

/// A motion whose truth is a closed form.
struct MotionExam {
  std::string name;
  mechanics::LagrangianText text;
  mechanics::State start;
  double restitution = 0;
  double until = 0;
  /// How many times larger than where it is made an error is at the end, about.
  double growth = 1;
  /// Relative to what the system moves.
  std::function<double(const MotionOutcome&)> error;
  bool needs_events = false;  ///< what is asked for is an event: time-stepping has none of its kind
};

/// The integrators before an exam: the setting is the tolerance of `event-driven`, and the step of
/// `time-stepping`, unless `steps` says into how many steps the time is divided. An error of `event-driven`
/// above ten times tolerance · growth, of which it says nothing, is wrong; time-stepping claims no bound.
std::vector<Contest> motion_contests(MotionExam exam, long steps = 0);

/// "event-driven", "time-stepping".
std::vector<std::string> integrator_names();

/// A ball of 1 m under g = 9.81, e = 0.9.
MotionExam falling_ball(double until);
/// x'' = -x, x >= 0, e = 0.8, from rest at 1: x = e^k |cos t|.
MotionExam stopped_oscillator(double until);
/// An orbit of eccentricity 1/2, which comes back after each period.
MotionExam kepler_orbit(int periods);
/// Balls over one floor, each from its own height, e = 0.5, for 1 s.
MotionExam many_balls(int count);

}  // namespace cli::inline measurement
