#include "mechanics/symbolic_equations.hpp"

#include "mechanics/expression/gradient_nodes.hpp"
#include "mechanics/expression/simplification.hpp"
#include "mechanics/expression/total_derivative.hpp"

namespace mechanics {

using namespace expression;

namespace {

/// Builds on a copy of the model's tape; no_node is 0.
class SymbolicDerivation {
 public:
  SymbolicDerivation(const LagrangianModel& model, const std::vector<Index>& contacts, ConstantsAs constants)
      : model_(model),
        contacts_(contacts),
        n_(model.coordinates.size()),
        tape_(model.tape),
        constants_(constants) {}

  SymbolicEquations equations() {
    derive();
    SymbolicEquations found;
    found.coordinates = model_.coordinates;
    Simplification simplified(tape_, found.tape, constants_ == ConstantsAs::numbers);
    const auto node = [&](NodeId x) { return x == no_node ? found.tape.literal("0", 0, {}) : simplified(x); };
    const auto nodes = [&](const std::vector<NodeId>& from) {
      std::vector<NodeId> to;
      for (const NodeId x : from) to.push_back(node(x));
      return to;
    };
    for (const auto& row : A_) found.A.push_back(nodes(row));
    found.z = nodes(z_);
    for (const auto& row : U_) found.U.push_back(nodes(row));
    found.s = nodes(s_);
    return found;
  }

 private:
  NodeId sum(NodeId x, NodeId y) {
    if (x == no_node) return y;
    if (y == no_node) return x;
    return tape_.apply(Operation::add, x, y, tape_.origin(x));
  }
  NodeId negative(NodeId x) {
    return x == no_node ? x : tape_.apply(Operation::negate, x, x, tape_.origin(x));
  }
  /// (∂x/∂q) q' + ∂x/∂t.
  NodeId rate(const GradientNodes& gradient) {
    NodeId total = gradient.by_time;
    for (const auto& [j, derivative] : gradient.by_coordinate) {
      const Origin at = tape_.origin(derivative);
      total = sum(total, tape_.apply(Operation::multiply, derivative, tape_.velocity(j, at), at));
    }
    return total;
  }

  void derive() {
    const NodeId T = model_.kinetic;
    const NodeId lagrangian = model_.potential == no_node
                                  ? T
                                  : tape_.apply(Operation::subtract, T, model_.potential, tape_.origin(T));
    const GradientNodes of_lagrangian = gradient_nodes(tape_, lagrangian);
    A_.assign(n_, std::vector<NodeId>(n_, no_node));
    z_.assign(n_, no_node);
    for (const auto& [i, derivative] : of_lagrangian.by_coordinate) z_[i] = derivative;
    for (std::size_t i = 0; i < n_; ++i) z_[i] = sum(z_[i], model_.forces[i]);
    for (const auto& [i, p] : of_lagrangian.by_velocity) {
      const GradientNodes of_momentum = gradient_nodes(tape_, p);
      for (const auto& [j, entry] : of_momentum.by_velocity)
        if (j <= i) A_[i][j] = A_[j][i] = entry;
      z_[i] = sum(z_[i], negative(rate(of_momentum)));
    }
    for (const Index a : contacts_) {
      const NodeId f = model_.f[static_cast<std::size_t>(a)];
      std::vector<NodeId> row(n_, no_node);
      for (const auto& [i, u] : gradient_nodes(tape_, f).by_coordinate) row[i] = u;
      U_.push_back(std::move(row));
      const NodeId df = TotalDerivative(tape_).of(f);
      s_.push_back(negative(rate(gradient_nodes(tape_, df))));
    }
  }

  const LagrangianModel& model_;
  const std::vector<Index>& contacts_;
  std::size_t n_;
  Tape tape_;
  ConstantsAs constants_;
  std::vector<std::vector<NodeId>> A_, U_;
  std::vector<NodeId> z_, s_;
};

}  // namespace

SymbolicEquations symbolic_equations(const LagrangianModel& model, const std::vector<Index>& contacts,
                                     ConstantsAs constants) {
  return SymbolicDerivation(model, contacts, constants).equations();
}

}  // namespace mechanics
