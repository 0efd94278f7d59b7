#pragma once

#include "cli/options.hpp"

namespace cli {

/// `moreau solve FILE…`: solves each problem file.
Exit solve_command(const Options&);

/// `moreau check FILE…`: puts each problem's answer to the laws that it must obey.
Exit check_command(const Options&);

/// `moreau check --catalogue`: the laws over every set, function and operation of the language.
Exit check_catalogue(const Options&);

/// `moreau derive FILE…`: A, z, U, s of a system at its state.
Exit derive_command(const Options&);

/// `moreau simulate FILE…`: the motion, with its events.
Exit simulate_command(const Options&);

/// `moreau orbit FILE --period P`: a periodic motion, its multipliers, its branch over a parameter.
Exit orbit_command(const Options&);

/// `moreau methods`: the methods of solution that a file can name.
Exit methods_command(const Options&);

/// `moreau prox "f" --at "[…]"`: splits a point into prox_f and the prox of the conjugate.
Exit prox_command(const Options&);

/// `moreau conjugate "f"`: the conjugate as an expression, its domain, its value.
Exit conjugate_command(const Options&);

/// `moreau chart [FILE…]`: speed against accuracy, every method.
Exit chart_command(const Options&);

/// `moreau stress [FAMILY…]`: where each method fails.
Exit stress_command(const Options&);

/// `moreau gallery [FAMILY]`: the families of hard problems; an instance as a problem file.
Exit gallery_command(const Options&);

/// `moreau functions [NAME]`: the sets, functions and operations that a file can name.
Exit functions_command(const Options&);

}  // namespace cli
