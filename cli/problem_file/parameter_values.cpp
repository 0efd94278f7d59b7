#include "cli/problem_file/parameter_values.hpp"

#include <charconv>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/numbers_by_constraint.hpp"
#include "mechanics/number_text.hpp"

namespace cli::inline problem_files {

using convex::InvalidInput;

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
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

double value_of(const Problem& problem, const mechanics::LagrangianSystem& system,
                const std::string& expression, const std::string& where) {
  // A time is an expression in the parameters.
  mechanics::StateText state = std::get<SystemProblem>(problem.content).state;
  state.t = mechanics::Text{expression, {}};
  try {
    return system.state(state).t;
  } catch (const InvalidInput& error) {
    const std::string what = error.what(), prefix = "t of the state: ";  // it was read as one
    throw InvalidInput(where + " " + expression + ": " +
                       (what.starts_with(prefix) ? what.substr(prefix.size()) : what));
  }
}

double value_of(const Problem& problem, const mechanics::LagrangianSystem& system, const std::string& text,
                const std::string& where, std::optional<convex::Place> place) {
  double value = 0;
  const std::from_chars_result number = std::from_chars(text.data(), text.data() + text.size(), value);
  if (number.ec == std::errc() && number.ptr == text.data() + text.size()) return value;
  try {
    return value_of(problem, system, text, where);
  } catch (const InvalidInput& error) {
    throw InvalidInput(error.what(), place);
  }
}

convex::Vector restitutions(const Problem& problem, const mechanics::LagrangianSystem& system) {
  double of_all = 0;
  std::vector<NamedNumber> by_name;
  const auto add = [&](const Restitution& one) {
    const double e = value_of(problem, system, one.e.text, one.where, one.e.begin);
    require_restitution(e, one.e.text + " = " + mechanics::number_text(e), one.where, one.e.begin);
    if (one.constraint.empty())
      of_all = e;
    else
      by_name.push_back({one.constraint, one.place, e});
  };
  for (const Restitution& one : std::get<SystemProblem>(problem.content).restitutions) add(one);
  // Those of [simulate] come later, and win.
  for (const Restitution& one : problem.simulate.restitutions) add(one);
  std::vector<std::string> names;
  for (const mechanics::Constraint& constraint : system.constraints()) names.push_back(constraint.name);
  return numbers_by_constraint("simulate.restitution", of_all, by_name, names);
}

}  // namespace cli::inline problem_files
