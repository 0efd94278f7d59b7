#pragma once

#include <memory>

#include "mechanics/data_radii.hpp"

namespace mechanics {

/// A mechanism and its state as they were written, and the state in doubles with what reading it rounded.
struct WrittenMechanism {
  std::shared_ptr<const LagrangianSystem> system;
  StateText text;
  State state;
  StateRadii radii;
  /// Constraints, in order, that the state declares to be in contact: as two-sided ones do, they hold by
  /// declaration, whatever digits the state has.
  std::vector<Index> in_contact = {};
};

/// Reads the state. Throws InvalidInput as `LagrangianSystem::state` does.
WrittenMechanism written_mechanism(std::shared_ptr<const LagrangianSystem>, StateText);

}  // namespace mechanics
