#pragma once

#include <optional>

#include "mechanics/expression/lagrangian_model.hpp"

namespace mechanics::expression {

/// The instant and the values of a state as nodes of constants alone. A value may use t, definitions,
/// coordinates and velocities that the state gives, in any order, and '; each stands here for what the state
/// gives for it. Conditions are decided as written.
struct StateNodes {
  Sources sources;
  Tape tape;
  NodeId t = no_node;        ///< no_node: not given (it is then 0)
  std::vector<NodeId> q, v;  ///< no_node: not given (a velocity is then 0)
};

/// Whether a value of the state uses more than parameters, t and indices, or decides by a condition. Without
/// that the values are numbers as they are read, which is quicker.
bool needs_nodes(const LagrangianModel&, const StateText&);

/// Throws InvalidInput for a value that needs itself, or a position that is not given.
StateNodes state_nodes(const LagrangianModel&, const StateText&);

}  // namespace mechanics::expression
