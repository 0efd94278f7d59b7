#pragma once

#include <optional>
#include <string>

#include "cli/problem_file/problem.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace cli::inline problem_files {

/// The value of an expression in the parameters of a system alone; none where it uses more than these, or is
/// wrong, which is told where it stands.
std::optional<double> value_in_parameters(const mechanics::LagrangianText& system,
                                          const std::string& expression);

/// The value of an expression in the parameters of a file. `where` names it in messages.
double value_of(const Problem&, const mechanics::LagrangianSystem&, const std::string& expression,
                const std::string& where);

/// The same of a number too, which needs no parameters; what is wrong is told at its place in the file.
double value_of(const Problem&, const mechanics::LagrangianSystem&, const std::string& text,
                const std::string& where, std::optional<convex::Place>);

/// e by constraint, of the parameters that the problem has. Throws InvalidInput where one is not from 0 to 1.
convex::Vector restitutions(const Problem&, const mechanics::LagrangianSystem&);

}  // namespace cli::inline problem_files
