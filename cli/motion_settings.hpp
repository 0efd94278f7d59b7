#pragma once

#include "cli/options.hpp"
#include "cli/problem_file/problem.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli {

/// The way that the file or the command line asks for; event-driven unless told. Throws InvalidInput for
/// another name.
mechanics::MotionMethod motion_method(const SimulateSettings&, const MotionChoice&);

/// How to follow the motion of a [system]: [simulate], [solve] contact_tolerance, what looseness has of its
/// own; options of the command line win.
mechanics::MotionOptions motion_options(const Problem&, const mechanics::System&, const MotionChoice&);

}  // namespace cli
