#pragma once

#include <memory>

#include "mechanics/lagrangian_system.hpp"

namespace mechanics {

/// A mechanism and its state as they were written, and the state in doubles.
struct WrittenMechanism {
  std::shared_ptr<const LagrangianSystem> system;
  StateText text;
  State state;
};

}  // namespace mechanics
