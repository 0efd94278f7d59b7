#include "cli/problem_file/parameter_values.hpp"

#include "mechanics/lagrangian_system.hpp"

namespace cli::inline problem_files {

std::optional<double> value_in_parameters(const mechanics::LagrangianText& system,
                                          const std::string& expression) {
  // A system of these parameters, whose time is the value that is asked for.
  mechanics::LagrangianText text;
  text.coordinates = {{"_of_parameters", {}}};
  text.kinetic = {"_of_parameters'^2", {}};
  text.parameters = system.parameters;
  text.table_file = system.table_file;
  mechanics::StateText state;
  state.t = mechanics::Text{expression, {}};
  state.position = {{{"_of_parameters", {}}, {"0", {}}}};
  try {
    return mechanics::lagrangian_system(text)->state(state).t;
  } catch (const convex::InvalidInput&) {
    return std::nullopt;
  }
}

}  // namespace cli::inline problem_files
