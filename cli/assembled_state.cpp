#include "cli/assembled_state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "cli/problem_file/keys.hpp"
#include "convex/nearest_name.hpp"
#include "mechanics/number_text.hpp"

namespace cli {
namespace {

using convex::InvalidInput;
using mechanics::Index;
using mechanics::LagrangianSystem;

std::vector<Index> members_named(const std::vector<std::string>& known, const std::vector<std::string>& names,
                                 const std::string& what, const char* kind) {
  std::vector<Index> found;
  for (const std::string& name : names) {
    const std::size_t before = found.size();
    for (std::size_t k = 0; k < known.size(); ++k)
      if (known[k] == name || known[k].rfind(name + "[", 0) == 0) found.push_back(static_cast<Index>(k));
    if (found.size() > before) continue;
    throw InvalidInput(what + ": there is no " + kind + " \"" + shown(name) + "\"; " +
                       convex::suggestion(name, known));
  }
  return found;
}

}  // namespace

std::vector<Index> constraints_named(const LagrangianSystem& system, const std::vector<std::string>& names,
                                     const std::string& what) {
  std::vector<std::string> known;
  for (const mechanics::Constraint& constraint : system.constraints()) known.push_back(constraint.name);
  return members_named(known, names, what, "constraint");
}

std::vector<Index> coordinates_named(const LagrangianSystem& system, const std::vector<std::string>& names,
                                     const std::string& what) {
  return members_named(system.coordinates(), names, what, "coordinate");
}

mechanics::AssemblyQuestion declared_question(const LagrangianSystem& system, const DeclaredState& declared) {
  mechanics::AssemblyQuestion question;
  try {
    question.contacts = constraints_named(system, declared.in_contact, "state.in_contact");
    if (declared.solve_for) {
      const std::vector<Index> moving = coordinates_named(system, *declared.solve_for, "state.solve_for");
      for (Index i = 0; i < static_cast<Index>(system.coordinates().size()); ++i)
        if (std::find(moving.begin(), moving.end(), i) == moving.end()) question.held.push_back(i);
    }
  } catch (const InvalidInput& error) {
    throw InvalidInput(error.what(), declared.place);
  }
  return question;
}

mechanics::StateText state_text(const LagrangianSystem& system, const mechanics::State& state,
                                const mechanics::StateText& before) {
  mechanics::StateText text = before;
  convex::Place place;
  if (before.position_table) place = before.position_table->begin;
  text.position.clear();
  text.velocity.clear();
  for (std::size_t i = 0; i < system.coordinates().size(); ++i) {
    const auto k = static_cast<Index>(i);
    text.position.push_back({{system.coordinates()[i], place}, {fmt::format("{}", state.q[k]), place}});
    text.velocity.push_back({{system.coordinates()[i], place}, {fmt::format("{}", state.v[k]), place}});
  }
  return text;
}

std::string fighting_text(const LagrangianSystem& system, const std::vector<Index>& fighting) {
  std::string list;
  for (const Index a : fighting)
    list += (list.empty() ? "" : ", ") + system.constraints()[static_cast<std::size_t>(a)].name;
  return list;
}

std::string position_text(const LagrangianSystem& system, const mechanics::State& state) {
  constexpr std::size_t most_told = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(most_told, system.coordinates().size()); ++i)
    text += (i > 0 ? ", " : "") + system.coordinates()[i] + " = " +
            mechanics::number_text(state.q[static_cast<Index>(i)]);
  return text + (system.coordinates().size() > most_told ? ", …" : "");
}

Moved moved_from(const LagrangianSystem& system, const mechanics::State& given,
                 const mechanics::Assembly& found) {
  const mechanics::Vector change = found.state.v - given.v;
  return {found.moved, std::sqrt(change.dot(system.inertia(given).A * change))};
}

void assemble_declared(Problem& problem, const std::string& file) {
  if (const auto moved = assemble_declared(problem))
    fmt::print(stderr,
               "moreau: {}: the state was assembled; in the kinetic metric the position moved by {} and the "
               "velocity changed by {}\n",
               file, mechanics::number_text(moved->position), mechanics::number_text(moved->velocity));
}

std::optional<Moved> assemble_declared(Problem& problem) {
  auto* text = std::get_if<SystemProblem>(&problem.content);
  if (text == nullptr || !text->declared) return std::nullopt;
  const auto system = mechanics::lagrangian_system(text->system, text->state);
  const mechanics::State given = system->state(text->state);
  const mechanics::Assembly found =
      mechanics::assemble(*system, given, declared_question(*system, *text->declared));
  if (found.status != mechanics::AssemblyStatus::solved)
    throw InvalidInput(
        found.status == mechanics::AssemblyStatus::infeasible
            ? "state.in_contact: no state was found, " + fighting_text(*system, found.fighting) +
                  (found.proved      ? " exclude each other (proved)"
                   : found.are_rates ? " hold where the search ends, but no velocity keeps them"
                                     : " do not hold together near the one given") +
                  "; see `moreau assemble`"
            : "state.in_contact: no state was found from the one given; give a closer one",
        text->declared->place);
  text->state = state_text(*system, found.state, text->state);
  return moved_from(*system, given, found);
}

}  // namespace cli
