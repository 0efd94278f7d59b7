#pragma once

#include <string>

#include "mechanics/motion/period_map.hpp"

namespace mechanics::inline motions {

/// Whether T + V stays as it is between impacts, by the text: t stands nowhere in it, and there are no forces
/// besides V.
bool keeps_energy_between_impacts(const LagrangianSystem& system);

/// That a motion with these events does not come back: nothing else changes its energy, and an impact takes
/// some, however little that is. Nothing where this is not so.
std::string lost_energy(const LagrangianSystem& system, const MotionOptions& options,
                        const std::vector<MotionEvent>& events);

/// Why a motion that comes back to its start x within a tolerance, `flight`, is no orbit by its impacts, or
/// nothing. A tolerance on positions and velocities does not tell: an impact of normal speed w, in a motion
/// of speed 1, takes energy of the order w², and moves the time of the return by the order w.
/// The impacts of an orbit have the same speeds a period later; and see `lost_energy`.
std::string why_not_repeated(const LagrangianSystem& system, const OrbitQuestion& question,
                             const PeriodMap& map, const Flight& flight, const Vector& x, double period);

}  // namespace mechanics::inline motions
