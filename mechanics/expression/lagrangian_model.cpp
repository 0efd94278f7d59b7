#include "mechanics/expression/lagrangian_model.hpp"

#include <cmath>

#include "mechanics/expression/sweeps.hpp"

namespace mechanics::expression {
namespace {

/// The first node, operands first, whose constant value is not finite.
NodeId first_undefined(const Tape& tape, NodeId constant) {
  for (;;) {
    NodeId next = no_node;
    if (arity(tape.operation(constant)) >= 1 && !std::isfinite(tape.constant(tape.a(constant))))
      next = tape.a(constant);
    else if (arity(tape.operation(constant)) == 2 && !std::isfinite(tape.constant(tape.b(constant))))
      next = tape.b(constant);
    if (next == no_node) return constant;
    constant = next;
  }
}

bool is_finite(const Partials& p) { return std::isfinite(p.a) && std::isfinite(p.b); }
bool is_finite(const SecondPartials& p) {
  return std::isfinite(p.aa) && std::isfinite(p.ab) && std::isfinite(p.bb);
}

[[noreturn]] void refuse(const LagrangianModel& model, const std::string& name, NodeId node,
                         const char* wrong) {
  if (model.tape.operation(node) == Operation::sign)
    throw convex::InvalidInput(
        name + ": " + quoted("abs(" + written(model.tape, model.tape.a(node), model.coordinates) + ")") +
            " has no derivative where its argument is 0, as at this state; start where it has one, or "
            "rewrite the "
            "expression",
        model.sources.place(model.tape.origin(node)));
  if (model.tape.operation(node) == Operation::literal && std::isnan(model.tape.constant(node)))
    throw convex::InvalidInput(
        name + ": " + model.tape.text(node) +
            " is asked for at this state; give the table a wider range, or stay within it",
        model.sources.place(model.tape.origin(node)));
  throw convex::InvalidInput(name + ": " + quoted(written(model.tape, node, model.coordinates)) + wrong,
                             model.sources.place(model.tape.origin(node)));
}

}  // namespace

void refuse_values(const LagrangianModel& model, const Program& program, std::size_t group, const Values& x,
                   int derivatives, const std::vector<std::string>& names) {
  constexpr const char* no_value =
      " is not finite at this state; start where it is, or rewrite the expression";
  constexpr const char* no_derivative =
      " has no finite derivative at this state, and one is needed; start where it has one, or rewrite the "
      "expression";
  const auto& roots = program.roots(group);
  Gradients search(program);
  const std::vector<bool> used = program.in_use(x, group);
  for (int order = 0; order <= derivatives; ++order)
    for (std::size_t r = 0; r < roots.size(); ++r) {
      const std::vector<Slot> below = search.below(roots[r]);
      if (order == 0 && program.is_constant(roots[r]) && !std::isfinite(x[roots[r]]))
        refuse(model, names[r], first_undefined(model.tape, program.node(roots[r])), no_value);
      for (const Slot slot : below) {
        if (!used[slot]) continue;
        const auto& i = program[slot];
        if (order == 0)
          for (const Slot operand : {i.a, i.b})
            if (used[operand] && program.is_constant(operand) && !std::isfinite(x[operand]))
              refuse(model, names[r], first_undefined(model.tape, program.node(operand)), no_value);
        if (order == 0 && !std::isfinite(x[slot])) refuse(model, names[r], program.node(slot), no_value);
        if (order >= 1 && !is_finite(program.partials(slot, x)))
          refuse(model, names[r], program.node(slot), no_derivative);
        if (order == 2 && !is_finite(program.second_partials(slot, x)))
          refuse(model, names[r], program.node(slot), no_derivative);
      }
    }
  const NodeId root = program.node(roots.front());
  throw convex::InvalidInput(
      names.front() +
          ": a value or a derivative is too large for a double at this state; "
          "choose other units",
      root == no_node ? std::nullopt : std::optional(model.sources.place(model.tape.origin(root))));
}

}  // namespace mechanics::expression
