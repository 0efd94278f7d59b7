#pragma once

#include <optional>
#include <string>

#include "mechanics/lagrangian_text.hpp"

namespace cli::inline problem_files {

/// The value of an expression in the parameters of a system alone; none where it uses more than these, or is
/// wrong, which is told where it stands.
std::optional<double> value_in_parameters(const mechanics::LagrangianText& system,
                                          const std::string& expression);

}  // namespace cli::inline problem_files
