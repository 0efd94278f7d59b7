#pragma once

#include "mechanics/motion/motion.hpp"

namespace mechanics::inline motions {

/// The course of a motion: what `Motion` knows between two steps, whatever way it is followed.
class Motion::Course {
 public:
  Course(const LagrangianSystem& of, MotionOptions chosen);
  virtual ~Course() = default;
  Course(const Course&) = delete;
  Course& operator=(const Course&) = delete;

  virtual bool advance(double until) = 0;

  /// A contact that a decided accumulation has brought to rest already; told when its time has come.
  struct Ending {
    double t;
    std::vector<Index> constraints;
  };

  MotionOptions options;
  const LagrangianSystem& system;
  State state;
  Arc done;  ///< the arc behind `state`
  std::vector<MotionEvent> events;
  std::vector<Ending> endings;  ///< by time
  MotionStatus status = MotionStatus::done;
  std::string why;
  std::vector<Index> excluding;
  MotionRecord record;
  Vector acceleration, multipliers;

 protected:
  bool is_two_sided(Index a) const { return system.constraints()[static_cast<std::size_t>(a)].two_sided; }
  const std::string& constraint_name(Index a) const {
    return system.constraints()[static_cast<std::size_t>(a)].name;
  }
  /// Whether a step can be taken; `events` are those of the step to come.
  bool may_advance(double until);
  void stop(std::string reason);
  /// loss: how much, where that is a number.
  void remark(RemarkKind kind, std::string what, double loss = 0);
  void event(EventKind kind, std::vector<Index> constraints, Vector velocity_before);
  /// The accumulations whose time has come.
  void tell_endings();
  /// Takes note of f_a < 0, where the constraint has this scale.
  void note_penetration(Index a, double f, double scale);
};

/// A motion that is not begun, and why.
class Motion::NotBegun final : public Motion::Course {
 public:
  NotBegun(const LagrangianSystem& of, const State& at, MotionOptions chosen, std::string reason)
      : Course(of, std::move(chosen)) {
    state = at;
    stop(std::move(reason));
  }
  bool advance(double) override { return false; }
};

}  // namespace mechanics::inline motions
