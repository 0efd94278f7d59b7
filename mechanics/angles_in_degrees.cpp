#include "mechanics/angles_in_degrees.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

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

/// sin(a), cos(a + b - c): a function of a turn whose argument is a sum of coordinates and what depends on
/// none.
struct Turn {
  NodeId function;
  std::vector<std::size_t> coordinates;
};

/// The coordinates of a sum; none where another term depends on one.
std::vector<std::size_t> coordinates_of_sum(const Tape& tape, NodeId sum) {
  std::vector<std::size_t> found;
  std::vector<NodeId> left{sum};
  while (!left.empty()) {
    const NodeId node = left.back();
    left.pop_back();
    const Operation operation = tape.operation(node);
    const bool is_sum = operation == Operation::add || operation == Operation::subtract;
    if ((tape.depends(node) & ~expression::on_time) == expression::on_nothing) continue;
    if (operation == Operation::coordinate)
      found.push_back(tape.a(node));
    else if (is_sum || operation == Operation::negate)
      left.push_back(tape.a(node));
    else
      return {};
    if (is_sum) left.push_back(tape.b(node));
  }
  return found;
}

/// Where the coordinates of a system occur in what is written of it: in turns, and elsewhere.
struct Occurrences {
  std::vector<Turn> turns;
  std::vector<bool> elsewhere;  ///< by coordinate
};

Occurrences occurrences(const expression::LagrangianModel& model) {
  const Tape& tape = model.tape;
  Occurrences found{{}, std::vector<bool>(model.coordinates.size(), false)};
  std::vector<bool> is_needed(tape.size(), false);
  const auto need = [&](NodeId node) {
    if (node != expression::no_node) is_needed[node] = true;
  };
  for (const NodeId root : {model.kinetic, model.potential}) need(root);
  for (const NodeId force : model.forces) need(force);
  for (const NodeId f : model.f) need(f);
  for (auto node = static_cast<NodeId>(tape.size()); node-- > 0;) {  // operands come before
    if (!is_needed[node]) continue;
    const Operation operation = tape.operation(node);
    if (operation == Operation::coordinate) found.elsewhere[tape.a(node)] = true;
    std::vector<std::size_t> angles;
    if (turns(operation)) angles = coordinates_of_sum(tape, tape.a(node));
    if (!angles.empty()) {
      found.turns.push_back({node, std::move(angles)});
      continue;
    }
    const int operands = expression::arity(operation);
    if (operands > 0) need(tape.a(node));
    if (operands > 1) need(tape.b(node));
  }
  std::reverse(found.turns.begin(), found.turns.end());
  return found;
}

/// Whether a coordinate has the inertia of one that is no angle, as x in m/2*(x'^2 + y'^2) beside
/// y >= sin(x): it is a length, too. Numbers carry no units, and an inertia of 1 tells as much as any.
bool moves_as_no_angle(const convex::SparseMatrix& A, const std::vector<bool>& elsewhere, std::size_t i) {
  const Vector diagonal = A.diagonal();
  for (std::size_t j = 0; j < elsewhere.size(); ++j)
    if (elsewhere[j] && diagonal[static_cast<Index>(j)] == diagonal[static_cast<Index>(i)]) return true;
  return false;
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
  std::vector<std::string> found = angles_in_degrees(system);
  if (std::none_of(state.q.begin(), state.q.end(), may_be_degrees)) return found;
  const Occurrences occurs = occurrences(model);
  std::vector<bool> is_settled = occurs.elsewhere;
  std::optional<convex::SparseMatrix> A;
  for (const Turn& turn : occurs.turns)
    for (const std::size_t i : turn.coordinates) {
      const double position = state.q[static_cast<Index>(i)];
      if (is_settled[i] || !may_be_degrees(position)) continue;
      is_settled[i] = true;
      if (!A) A = system.inertia(state).A;
      if (moves_as_no_angle(*A, occurs.elsewhere, i)) continue;
      const std::string number = expression::count_text(position);
      found.push_back(at_line(model, turn.function) + expression::quoted(model.coordinates[i]) +
                      ", which stands at " + number +
                      ", counts in radians; where degrees are meant, give its position as \"" + number +
                      "*pi/180\"");
    }
  return found;
}

convex::InvalidInput refused_state(const convex::InvalidInput& error, convex::Place place,
                                   const LagrangianSystem& system, const State& state) {
  std::vector<std::string> angles = angles_in_degrees(system);
  try {
    angles = angles_in_degrees(system, state);
  } catch (const convex::InvalidInput&) {  // what is not finite is told by the error
  }
  return {convex::InvalidInput(error.what() + (angles.empty() ? "" : " (" + angles.front() + ")"),
                               error.place().value_or(place)),
          error.others()};
}

}  // namespace mechanics
