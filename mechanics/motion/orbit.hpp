#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/motion/motion.hpp"

namespace mechanics::inline motions {

/// What is to come back.
struct OrbitQuestion {
  MotionOptions motion;
  double period = 0;     ///< all of it, k periods of the forcing; of a free one, a guess, or 0
  bool is_free = false;  ///< the period is unknown
  /// Of a free period of a system that keeps its energy, whose orbits are families by it: the one asked for;
  /// that of the guess, if none is given.
  std::optional<double> energy;
  Vector modulo;  ///< n: a coordinate comes back up to a multiple of this; 0: it comes back itself
};

/// A periodic motion: its state at the time of the guess, its period, the derivative of the map over the
/// period.
struct Orbit {
  bool is_found = false;
  std::string why;  ///< if it is not
  State start;
  double period = 0;
  double residual = 0;  ///< how far the motion misses its start, relative to how far it goes
  /// Eigenvalues of the derivative, the largest first, 2 (n - k) of them with k independent two-sided
  /// constraints; none where the map has no derivative: impacts come,
  /// go, or change their order however little the start is moved.
  std::optional<std::vector<std::complex<double>>> multipliers;
  bool is_stable = false;   ///< all inside the unit circle, but for the 1 along an orbit of free period
  bool is_neutral = false;  ///< not stable, and none is outside: the largest are on the circle
  /// What is not told from the unit circle lies this near to it: the error of the moduli, larger where two
  /// multipliers are nearly one.
  double circle_width = 0;
  std::vector<MotionEvent> impacts;
  /// Constraints of which infinitely many impacts come to an end on the way; `impacts` has so many of them as
  /// were followed.
  std::vector<Index> accumulating;
  /// The state of the orbit at the instant of the period from `start` that is furthest from all events, free
  /// of contacts if there is such a one, and how far the events are from it, and from the start.
  State quiet;
  double quiet_margin = 0, start_margin = 0;
  Vector largest;  ///< how far each of q and v goes on the way: 2n
  /// By constraint: the least of its gap where it turns around without a contact, and of |df/dt| at its
  /// impacts; infinite where there is none.
  Vector least_gap, least_closing;
  /// By one-sided constraint: the least of its multiplier where it turns around while it is held, infinite
  /// where there is none; and how often it opens.
  Vector least_pressing;
  std::vector<int> releases;
};

/// Its multipliers but the 1 along an orbit of free period.
std::vector<std::complex<double>> multipliers_across(const Orbit&, bool is_free);

/// Newton's method on the map over one period, from a guess (shooting), on the states that satisfy the
/// two-sided constraints in f and df/dt; the guess is brought to them, and out of one-sided constraints that
/// it penetrates (`assemble`). The derivative of the map, of which the multipliers are the eigenvalues too,
/// is that of the variational equations with saltation matrices
/// (`flow_derivative`). Where an event at the start hides the derivative, the map is the one from a quiet
/// instant of the period, and the orbit is told at the time of the guess again (`orbit_from`). With an
/// unknown period the start is nearest to the guess across the motion; where the energy is kept, orbits come
/// in families, and the one of a given energy is found (the conditions of Muñoz-Almaraz et al. 2003, as least
/// squares that vanish). Of other families, as by symmetries, it is the one by the least changes. Laws of
/// impact that have none here are differentiated by differences, of the eighth order for the multipliers.
/// Throws InvalidInput where the guess cannot begin a motion.
Orbit find_orbit(const LagrangianSystem& system, const State& guess, const OrbitQuestion& question);

}  // namespace mechanics::inline motions
