#include <cmath>

#include "mechanics/expression/assignment.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/rounded_nodes.hpp"
#include "mechanics/expression/state_nodes.hpp"

namespace mechanics::expression {
namespace {

/// The values that a table of the state gives; `missing` lists the coordinates that it does not give.
Vector read_values(const LagrangianModel& model, const std::vector<NamedText>& texts,
                   const std::string& table, double t, Sources& sources, Expansion& expansion,
                   std::vector<Index>& missing) {
  const auto& families = model.meanings.coordinate_families;
  const Assignment given = assign_to_coordinates(texts, table, table + " of ", model.names, families,
                                                 Vocabulary::state, sources, expansion);
  Vector values = Vector::Zero(static_cast<Index>(model.coordinates.size()));
  for (const Family& family : families)
    for (std::uint32_t m = 0; m < family.members.size(); ++m) {
      const auto i = static_cast<Index>(family.first + m);
      const std::uint32_t entry = given.entry_of[family.first + m];
      if (entry == no_entry)
        missing.push_back(i);
      else
        values[i] = expansion.number(given.entries[entry].value, family.members[m], t);
    }
  return values;
}

/// Where the value of a coordinate stands; that of its table where a family gives it.
std::optional<convex::Place> place_of(const std::string& coordinate, const std::vector<NamedText>& texts,
                                      const StateText& state) {
  for (const NamedText& text : texts)
    if (text.name.text == coordinate) return text.value.begin;
  return state.position_table ? std::optional(state.position_table->begin) : std::nullopt;
}

/// Values that use each other, definitions and '.
Vector values_of(const std::vector<NodeId>& nodes, const StateText& text, const std::vector<NamedText>& texts,
                 const std::vector<Rounded>& numbers, const std::string& table, const LagrangianModel& model,
                 std::vector<Index>& missing) {
  Vector values = Vector::Zero(static_cast<Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = static_cast<Index>(i);
    if (nodes[i] == no_node) {
      missing.push_back(k);
      continue;
    }
    values[k] = numbers[nodes[i]].value;
    if (!std::isfinite(values[k]))
      throw convex::InvalidInput(
          table + " of " + model.coordinates[i] +
              ": its value is not finite here (a table outside its range, a root of a negative number, a "
              "division by 0); correct the expression",
          place_of(model.coordinates[i], texts, text));
  }
  return values;
}

}  // namespace

State read_state(const LagrangianModel& model, const StateText& text) {
  Sources sources;
  Tape tape;
  Expansion expansion(model.meanings, tape);
  State state;
  if (text.t) {
    const Source& source = sources.add(*text.t, "t of the state");
    state.t = expansion.number(parse_expression(source, {&model.names, Vocabulary::instant, {}}), {});
  }
  std::vector<Index> missing, at_rest;
  const bool by_nodes = needs_nodes(model, text);
  if (by_nodes) {
    const StateNodes nodes = state_nodes(model, text);
    const std::vector<Rounded> numbers = rounded_nodes(nodes.tape);
    if (nodes.t != no_node) state.t = numbers[nodes.t].value;
    state.q = values_of(nodes.q, text, text.position, numbers, "position", model, missing);
    state.v = values_of(nodes.v, text, text.velocity, numbers, "velocity", model, at_rest);
  } else {
    convex::Mistakes mistakes;
    mistakes.gather([&] {
      state.q = read_values(model, text.position, "position", state.t, sources, expansion, missing);
    });
    mistakes.gather([&] {
      state.v = read_values(model, text.velocity, "velocity", state.t, sources, expansion, at_rest);
    });
    mistakes.tell();
  }
  if (!missing.empty()) {
    constexpr std::size_t most_named = 5;
    std::string list;
    for (std::size_t k = 0; k < std::min(missing.size(), most_named); ++k)
      list += (k == 0 ? "" : ", ") + model.coordinates[static_cast<std::size_t>(missing[k])];
    if (missing.size() > most_named) list += " and " + std::to_string(missing.size() - most_named) + " more";
    throw convex::InvalidInput(
        "position: " + list + " missing; give every coordinate",
        text.position_table ? std::optional(text.position_table->begin) : std::nullopt);
  }
  return state;
}

}  // namespace mechanics::expression
