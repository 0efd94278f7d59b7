#include "mechanics/angles_in_degrees.hpp"

#include <cmath>
#include <numbers>

#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace mechanics {
namespace {

using expression::NodeId;
using expression::Operation;
using expression::Tape;

/// Whether a number stands there as it is, or as the value of a parameter.
bool is_plain_number(const Tape& tape, NodeId node) {
  while (tape.operation(node) == Operation::parameter || tape.operation(node) == Operation::negate)
    node = tape.a(node);
  return tape.operation(node) == Operation::literal;
}

/// A whole number beyond a turn.
bool may_be_degrees(double angle) {
  const double size = std::abs(angle);
  return size > 2 * std::numbers::pi && size == std::floor(size);
}

bool turns(Operation operation) {
  return operation == Operation::sin || operation == Operation::cos || operation == Operation::tan;
}

/// "line 4: the angle".
std::string at_line(const expression::LagrangianModel& model, NodeId node) {
  return "line " + std::to_string(model.sources.place(model.tape.origin(node)).line) + ": the angle ";
}

}  // namespace

std::vector<std::string> angles_in_degrees(const LagrangianSystem& system) {
  const expression::LagrangianModel& model = system.model();
  const Tape& tape = model.tape;
  std::vector<std::string> found;
  for (NodeId node = 0; node < tape.size(); ++node) {
    if (!turns(tape.operation(node))) continue;
    const NodeId angle = tape.a(node);
    if (!tape.is_constant(angle) || !may_be_degrees(tape.constant(angle)) || !is_plain_number(tape, angle))
      continue;
    const std::string text = written(tape, angle, model.coordinates);
    found.push_back(at_line(model, node) + expression::quoted(text) + " = " +
                    expression::count_text(tape.constant(angle)) +
                    " counts in radians; where degrees are meant, write " + text + "*pi/180");
  }
  return found;
}

std::vector<std::string> angles_in_degrees(const LagrangianSystem& system, const State& state) {
  const expression::LagrangianModel& model = system.model();
  const Tape& tape = model.tape;
  std::vector<std::string> found = angles_in_degrees(system);
  std::vector<bool> is_told(model.coordinates.size(), false);
  for (NodeId node = 0; node < tape.size(); ++node) {
    if (!turns(tape.operation(node)) || tape.operation(tape.a(node)) != Operation::coordinate) continue;
    const std::size_t i = tape.a(tape.a(node));
    const double position = state.q[static_cast<Index>(i)];
    if (is_told[i] || !may_be_degrees(position)) continue;
    is_told[i] = true;
    const std::string number = expression::count_text(position);
    found.push_back(at_line(model, node) + expression::quoted(model.coordinates[i]) + ", which stands at " +
                    number + ", counts in radians; where degrees are meant, give its position as \"" +
                    number + "*pi/180\"");
  }
  return found;
}

convex::InvalidInput refused_state(const convex::InvalidInput& error, convex::Place place,
                                   const LagrangianSystem& system) {
  const std::vector<std::string> angles = angles_in_degrees(system);
  return {convex::InvalidInput(error.what() + (angles.empty() ? "" : " (" + angles.front() + ")"),
                               error.place().value_or(place)),
          error.others()};
}

}  // namespace mechanics
