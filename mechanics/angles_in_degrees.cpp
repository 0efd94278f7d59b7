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

}  // namespace

std::vector<std::string> angles_in_degrees(const LagrangianSystem& system) {
  const expression::LagrangianModel& model = system.model();
  const Tape& tape = model.tape;
  std::vector<std::string> found;
  for (NodeId node = 0; node < tape.size(); ++node) {
    const Operation operation = tape.operation(node);
    if (operation != Operation::sin && operation != Operation::cos && operation != Operation::tan) continue;
    const NodeId angle = tape.a(node);
    const double size = tape.is_constant(angle) ? std::abs(tape.constant(angle)) : 0;
    if (!(size > 2 * std::numbers::pi) || size != std::floor(size) || !is_plain_number(tape, angle)) continue;
    const std::string text = written(tape, angle, model.coordinates);
    found.push_back("line " + std::to_string(model.sources.place(tape.origin(node)).line) + ": the angle " +
                    expression::quoted(text) + " = " + expression::count_text(tape.constant(angle)) +
                    " counts in radians; where degrees are meant, write " + text + "*pi/180");
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
