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

/// The value of an expression in the parameters of a file. `where` names it in messages.
double value_of(const Problem&, const mechanics::LagrangianSystem&, const std::string& expression,
                const std::string& where);

/// `--modulo "a=2*pi"` by coordinate, 0 where there is none.
convex::Vector multiples_of_turns(const Problem&, const mechanics::LagrangianSystem&,
                                  const std::vector<std::string>& modulo);

}  // namespace cli
