#pragma once

#include <optional>

#include "mechanics/expression/lagrangian_model.hpp"

namespace mechanics::expression {

/// The values of a state as nodes of t alone. A value may use definitions, coordinates and velocities that
/// the state gives, in any order, and '; each stands here for what the state gives for it.
struct StateNodes {
  Sources sources;
  Tape tape;
  std::vector<NodeId> q, v;  ///< no_node: not given (a velocity is then 0)
};

/// Whether a value of the state uses more than parameters, t and indices. Without that the values are
/// numbers as they are read, which is quicker.
bool refers_to_state(const LagrangianModel&, const StateText&);

/// Throws InvalidInput for a value that needs itself, or a position that is not given.
StateNodes state_nodes(const LagrangianModel&, const StateText&);

}  // namespace mechanics::expression
