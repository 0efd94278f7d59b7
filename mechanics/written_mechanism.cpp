#include "mechanics/written_mechanism.hpp"

namespace mechanics {

WrittenMechanism written_mechanism(std::shared_ptr<const LagrangianSystem> system, StateText text) {
  State state = system->state(text);
  StateRadii radii = state_radii(*system, text, state);
  return {std::move(system), std::move(text), std::move(state), std::move(radii)};
}

}  // namespace mechanics
