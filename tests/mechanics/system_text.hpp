#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/lagrangian_system.hpp"

namespace tests {

using Lines = std::vector<std::pair<std::string, std::string>>;

/// The text of a system, written as a test reads best.
struct SystemText {
  std::vector<std::string> coordinates;
  std::string kinetic;
  std::string potential;  ///< none if empty
  Lines parameters, definitions, forces, constraints;
};

inline std::vector<mechanics::NamedText> named(const Lines& lines, int first_line) {
  std::vector<mechanics::NamedText> result;
  for (const auto& [name, value] : lines) {
    result.push_back({{name, {first_line, 1}}, {value, {first_line, 101}}});
    ++first_line;
  }
  return result;
}

/// Places: coordinate k at 1:k+1, kinetic 2:101, potential 3:101, parameters from line 10 on, definitions
/// from 20, forces from 30, constraints from 40; names in column 1, values in column 101.
inline mechanics::LagrangianText lagrangian_text(const SystemText& text) {
  mechanics::LagrangianText result;
  int column = 0;
  for (const auto& coordinate : text.coordinates) result.coordinates.push_back({coordinate, {1, ++column}});
  result.kinetic = {text.kinetic, {2, 101}};
  if (!text.potential.empty()) result.potential = mechanics::Text{text.potential, {3, 101}};
  result.parameters = named(text.parameters, 10);
  result.definitions = named(text.definitions, 20);
  result.forces = named(text.forces, 30);
  result.constraints = named(text.constraints, 40);
  return result;
}

inline std::unique_ptr<const mechanics::LagrangianSystem> system(const SystemText& text) {
  return mechanics::lagrangian_system(lagrangian_text(text));
}

/// Positions from line 60 on, velocities from 70, t at 50:101, the table of positions at 59:1.
inline mechanics::StateText state_text(const Lines& position, const Lines& velocity = {},
                                       const std::string& t = "") {
  mechanics::StateText text;
  if (!t.empty()) text.t = mechanics::Text{t, {50, 101}};
  text.position_table = mechanics::Text{"", {59, 1}};
  text.position = named(position, 60);
  text.velocity = named(velocity, 70);
  return text;
}

inline mechanics::State state(std::vector<double> q, std::vector<double> v, double t = 0) {
  const auto n = static_cast<mechanics::Index>(q.size());
  return {t, Eigen::Map<const mechanics::Vector>(q.data(), n),
          Eigen::Map<const mechanics::Vector>(v.data(), n)};
}

/// What the action throws: "line:column message", or "no error".
template <class Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const convex::InvalidInput& error) {
    const auto& place = error.place();
    const std::string where =
        place ? std::to_string(place->line) + ":" + std::to_string(place->column) : "nowhere";
    return where + " " + error.what();
  }
  return "no error";
}

}  // namespace tests
