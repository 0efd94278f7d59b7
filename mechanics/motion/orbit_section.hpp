#pragma once

#include "mechanics/motion/period_map.hpp"

namespace mechanics::inline motions {

/// What a motion over a period tells of the instants at which it may begin, and of the contacts that it meets
/// nearly: the figures of `Orbit` that come after its impacts.
void note_passage(const Flight& flight, const LagrangianSystem& system, Orbit& orbit);

/// The same orbit with its start at the instant t, and the impacts of the period from there. The map over a
/// period from another instant is the one of before moved along the motion: its fixed point is the state
/// there, its multipliers are the same. If t falls on an impact, the state is the one after it.
Orbit orbit_from(const LagrangianSystem& system, const Orbit& orbit, const OrbitQuestion& question, double t);

}  // namespace mechanics::inline motions
