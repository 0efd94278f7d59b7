#pragma once

#include "cli/options.hpp"
#include "cli/problem_file/parameter_values.hpp"
#include "cli/problem_file/problem.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli {

/// A way to follow a motion; why, where it was left open.
struct MotionWay {
  mechanics::MotionMethod method = mechanics::MotionMethod::event_driven;
  std::string why;
  bool is_open = false;  ///< it may turn to steps on the way
};

/// The way that the file or the command line asks for; event-driven unless told. "auto": time-stepping from
/// some hundred one-sided constraints on, with the reason. Throws InvalidInput for another name.
MotionWay motion_way(const SimulateSettings&, const mechanics::System&, const MotionChoice&);

/// How to follow the motion of a [system]: [simulate], [solve] contact_tolerance, what looseness has of its
/// own; options of the command line win.
mechanics::MotionOptions motion_options(const Problem&, const mechanics::LagrangianSystem&,
                                        const MotionChoice&);

/// A sentence for each key of [simulate] that the file's method does not use: step beside event-driven,
/// tolerance beside time-stepping. None where the method is told elsewhere, or is "auto".
std::vector<std::string> unused_settings(const SimulateSettings&, const MotionChoice&);

/// The end of a motion: that of the command line, or of [simulate]. Throws InvalidInput where neither is
/// there or it is not finite.
double end_of_motion(const Problem&, const mechanics::LagrangianSystem&,
                     const std::optional<std::string>& told);

/// `--modulo "a=2*pi"` by coordinate, 0 where there is none.
convex::Vector multiples_of_turns(const Problem&, const mechanics::LagrangianSystem&,
                                  const std::vector<std::string>& modulo);

}  // namespace cli
