#include "mechanics/motion/lagrange_equations.hpp"

#include <cstdint>
#include <set>

#include "mechanics/expression/cut_nodes.hpp"
#include "mechanics/expression/gradient_nodes.hpp"
#include "mechanics/expression/total_derivative.hpp"

namespace mechanics::inline motions {

using namespace expression;

namespace {

using ByVariable = std::vector<std::pair<std::uint32_t, NodeId>>;

/// F = ∂(T - V)/∂q + Q by coordinate; no_node where it is 0 by its structure.
std::vector<NodeId> forces(Tape& tape, const LagrangianModel& model, const CutNodes& cut,
                           const ByVariable& by_coordinate) {
  std::vector<NodeId> found(model.coordinates.size(), no_node);
  for (const auto& [i, derivative] : by_coordinate) found[i] = derivative;
  for (const Index i : model.forced) {
    const auto k = static_cast<std::size_t>(i);
    const NodeId Q = cut.of(model.forces[k]);
    found[k] = found[k] == no_node ? Q : tape.apply(Operation::add, found[k], Q, tape.origin(Q));
  }
  return found;
}

/// Whether a value of it is chosen by the sign of another.
bool takes_branches(const Tape& tape, NodeId of) {
  std::vector<NodeId> left{of};
  std::set<NodeId> seen{of};
  while (!left.empty()) {
    const NodeId node = left.back();
    left.pop_back();
    const Operation operation = tape.operation(node);
    if (is_branch(operation) || operation == Operation::abs || operation == Operation::sign) return true;
    const int count = arity(operation);
    if (count > 0 && seen.insert(tape.a(node)).second) left.push_back(tape.a(node));
    if (count > 1 && seen.insert(tape.b(node)).second) left.push_back(tape.b(node));
  }
  return false;
}

}  // namespace

LagrangeEquations::LagrangeEquations(const LagrangianModel& model) : tape(model.tape) {
  const CutNodes cut(tape);
  const NodeId T = cut.of(model.kinetic);
  const NodeId lagrangian = model.potential == no_node
                                ? T
                                : tape.apply(Operation::subtract, T, cut.of(model.potential), tape.origin(T));
  const GradientNodes of_lagrangian = gradient_nodes(tape, lagrangian);
  std::vector<NodeId> leading, following, last;
  for (const NodeId f : model.f) last.push_back(cut.of(f));
  // The model has T positive definite in q', so that every velocity is in it; one that is not has p = 0.
  std::vector<NodeId> p(model.coordinates.size(), tape.literal("0", 0, tape.origin(T)));
  for (const auto& [i, derivative] : of_lagrangian.by_velocity) p[i] = derivative;
  leading = p;
  TotalDerivative rate_of(tape);
  for (const NodeId f : last) leading.push_back(rate_of.of(f));

  const std::vector<NodeId> F = forces(tape, model, cut, of_lagrangian.by_coordinate);
  std::vector<ByVariable> gradients;
  for (const NodeId force_node : F)
    if (force_node != no_node) following.push_back(force_node);
  for (const NodeId f : last) {
    gradients.push_back(gradient_nodes(tape, f).by_coordinate);
    for (const auto& [i, u] : gradients.back()) following.push_back(u);
  }

  // Jumps of T, V or f have no derivative, and are met where what decides them comes to 0.
  for (const NodeId f : last)
    if (takes_branches(tape, f)) following.push_back(f);
  const bool has_steps = takes_branches(tape, lagrangian);
  if (has_steps) following.push_back(lagrangian);

  program = Program(tape, model.coordinates.size(), {leading, following, last});
  const auto& of_leading = program.roots(0);
  momentum.assign(of_leading.begin(), of_leading.begin() + static_cast<std::ptrdiff_t>(p.size()));
  rate.assign(of_leading.begin() + static_cast<std::ptrdiff_t>(p.size()), of_leading.end());
  auto next = program.roots(1).begin();
  for (std::size_t i = 0; i < F.size(); ++i)
    if (F[i] != no_node) force.emplace_back(static_cast<Index>(i), *next++);
  for (const ByVariable& gradient : gradients) {
    row.emplace_back();
    for (const auto& [i, u] : gradient) row.back().emplace_back(static_cast<Index>(i), *next++);
  }
  constraint = program.roots(2);
  if (has_steps) branching_lagrangian = program.roots(1).back();
}

namespace {

TaylorRows::Asked asked_of(const LagrangeEquations& equations, const TaylorSteps& steps) {
  TaylorRows::Asked asked{equations.rate, {}, equations.momentum};
  asked.at_rest.insert(asked.at_rest.end(), equations.rate.begin(), equations.rate.end());
  for (std::size_t i = 0; i < equations.program.coordinates(); ++i)
    asked.series.push_back(equations.program.coordinate(i));
  for (const auto& row : equations.row)
    for (const auto& [i, u] : row) asked.series.push_back(u);
  for (const FunctionArgument& one : steps.arguments) asked.series.push_back(one.argument);
  for (const auto& [i, F] : equations.force) asked.of_order.push_back(F);
  return asked;
}

}  // namespace

EquationsOfMotion::EquationsOfMotion(const expression::LagrangianModel& model)
    : equations(model), series([&] {
        TaylorSteps steps(equations.tape, equations.program);
        const TaylorRows::Asked asked = asked_of(equations, steps);
        return TaylorProgram(std::move(steps), asked, equations.momentum, equations.force);
      }()) {}

}  // namespace mechanics::inline motions
