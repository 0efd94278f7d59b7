#include "mechanics/motion/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/counted.hpp"
#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "convex/linear_algebra/complex_eigenvalues.hpp"
#include "mechanics/assembly.hpp"
#include "mechanics/motion/closed_impacts.hpp"
#include "mechanics/motion/first_return.hpp"
#include "mechanics/motion/lagrange_equations.hpp"
#include "mechanics/motion/orbit_section.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

using convex::Matrix;

constexpr int most_corrections_of_orbit = 60;

/// A step of Newton's method is halved until it leads nearer, down to this part.
constexpr double shortest_part = 1e-4;

/// The start is met when it is missed by less than this part of how far the motion goes.
constexpr double met = 1e-10;

/// Steps of differences, relative to how far the motion goes, where the derivative is not known otherwise: of
/// the second order for Newton's method, of the eighth for the multipliers; shorter ones where the events on
/// the way change.
constexpr double newton_step = 1e-6, multiplier_step = 1e-3, shortest_step = 1e-7;
constexpr int multiplier_levels = 4;

/// An event no further from the start than this part of the period may hide the derivative there.
constexpr double near_start = 1e-2;

/// Error of the derivative by the variational equations, relative to its largest norm on the way.
constexpr double derivative_error = 1e-12;

/// A free period is looked for within this factor of the guess: where there is no orbit, as beyond a fold,
/// Newton's method leads to flights without end.
constexpr double farthest_period = 4;

/// The derivative of the map, or what leads on where it has none.
std::optional<Matrix> for_newton(const PeriodMap& map, const TangentChart& chart, double period,
                                 const Flight& flight) {
  if (const FlowDerivative D = map.derivative(chart, flight); D.kind == FlowDerivative::Kind::known)
    return D.value;
  if (const auto D = map.differences(chart, period, flight, newton_step, 1, false)) return D;
  return map.differences(chart, period, flight, newton_step, 1, true);
}

FlowDerivative for_multipliers(const PeriodMap& map, const TangentChart& chart, double period,
                               const Flight& flight) {
  const FlowDerivative D = map.derivative(chart, flight);
  if (D.kind != FlowDerivative::Kind::undecided) return D;
  for (double step = multiplier_step; step > shortest_step; step *= 0.25)
    if (auto by_differences = map.differences(chart, period, flight, step, multiplier_levels, false))
      return {FlowDerivative::Kind::known, *by_differences, by_differences->norm()};
  return D;
}

/// The error of eigenvalues of a derivative that is itself off by E, a part of its largest norm on the way,
/// as beside a saddle: |E|, or where two are nearly one (2 |D| |E|)^(1/2), as in two dimensions (Elsner
/// 1985).
double circle_width(const std::vector<std::complex<double>>& multipliers, const FlowDerivative& D) {
  const double size = std::max(1.0, D.value.norm());
  const double error = derivative_error * std::max(size, D.growth), root = std::sqrt(2 * size * error);
  for (std::size_t i = 0; i < multipliers.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(multipliers[i] - multipliers[j]) < 4 * root) return root;
  return error;
}

/// T + V, asked to have a value: the last equation of Newton's method where orbits keep it.
class KeptEnergy {
 public:
  KeptEnergy(const LagrangianSystem& system, const OrbitQuestion& question, const State& guess)
      : system_(system) {
    is_kept_ = question.is_free && keeps_energy_between_impacts(system);
    if (is_kept_) value_ = question.energy.value_or(system.energy(guess));
  }
  bool is_kept() const { return is_kept_; }
  /// By how much it misses its value.
  double miss(const State& at) const { return is_kept_ ? system_.energy(at) - value_ : 0; }
  /// Its derivative by the coordinates of a chart, by differences over a distance.
  Vector slope(const TangentChart& chart, double distance) const {
    Vector by(chart.dimension());
    const double t = chart.origin().t;
    const Index n = chart.origin().q.size();
    for (Index k = 0; k < by.size(); ++k) {
      const double h = distance / chart.direction(k).norm();
      const auto energy = [&](double along) {
        const Vector x = chart.state_of(along * Vector::Unit(by.size(), k));
        return system_.energy({t, x.head(n), x.tail(n)});
      };
      by[k] = (energy(h) - energy(-h)) / (2 * h);
    }
    return by;
  }

 private:
  const LagrangianSystem& system_;
  bool is_kept_ = false;
  double value_ = 0;
};

/// A motion that comes back does so again a period later, to this part of how far it goes and to what the
/// rounding of t makes of it.
constexpr double again = 1e-6, roundings_of_phase = 100;

/// Whether what drives the motion from x is the same a period later, by the motion from there. A state that
/// comes back after some other time does not go on as it did. What cannot be followed there, as beyond the
/// end of a table, tells nothing.
bool is_driven_alike(const LagrangianSystem& system, const State& guess, const OrbitQuestion& question,
                     const Vector& x, double period) {
  if (question.is_free || !system.equations_of_motion().series.steps.uses_time) return true;
  const PeriodMap map(system, guess.t + period, question);
  const Flight flight = map.fly(x, period);
  const double by_rounding =
      roundings_of_phase * std::numeric_limits<double>::epsilon() * (std::abs(guess.t) + period) / period;
  return !flight.arrives || map.relative(map.miss(flight, x), flight) <= again + by_rounding;
}

/// Whether a motion goes no farther than it misses its start, by some thousand times: it stays near an
/// equilibrium, which comes back after any time.
bool is_at_rest(const Flight& flight, const Vector& x, const Vector& miss) {
  constexpr double farther = 1e3;
  Vector way = Vector::Zero(x.size());
  for (const FlightPiece& piece : flight.pieces) way = way.cwiseMax((as_one(piece.after) - x).cwiseAbs());
  const Index n = x.size() / 2;
  return way.head(n).maxCoeff() <= farther * miss.head(n).cwiseAbs().maxCoeff();
}

/// The guess, or where it lies behind a one-sided constraint the nearest state that does not: orbits on a
/// contact that moves with a parameter lead behind it at the next value.
State not_penetrated(const LagrangianSystem& system, const State& guess, const OrbitQuestion& question) {
  const ConstraintRates rates = system.constraint_rates(guess);
  const Vector& given = question.motion.contact_tolerance;
  bool is_penetrated = false;
  for (Index a = 0; a < rates.f.size(); ++a) {
    const double tolerance = given.size() == 0 ? default_contact_tolerance : given[a];
    is_penetrated = is_penetrated || (!system.constraints()[static_cast<std::size_t>(a)].two_sided &&
                                      rates.f[a] < -tolerance * rates.f_scale[a]);
  }
  if (!is_penetrated) return guess;
  const Assembly nearest = assemble(system, guess, {});
  return nearest.status == AssemblyStatus::solved ? nearest.state : guess;
}

/// The orbit by the map from the time of the guess.
Orbit find_orbit_there(const LagrangianSystem& system, const State& guess, const OrbitQuestion& question) {
  Orbit orbit;
  std::optional<TangentChart> chart(std::in_place, system, guess);
  orbit.start = chart->origin();
  orbit.period = question.period;
  if (question.is_free && !(orbit.period > 0)) orbit.period = return_time(system, orbit.start, question);
  if (!(orbit.period > 0)) {
    orbit.why = "the motion from the state of the file does not come near it again";
    return orbit;
  }
  const double longest = farthest_period * orbit.period, shortest = orbit.period / farthest_period;
  OrbitQuestion near = question;
  const PeriodMap map(system, guess.t, near);
  const Index n = guess.q.size(), size = chart->dimension(), unknowns = size + (question.is_free ? 1 : 0);
  Vector x = as_one(orbit.start);
  Flight flight = map.fly(x, orbit.period);
  if (!flight.arrives) {
    orbit.why = flight.why;
    return orbit;
  }
  note_passage(flight, system, orbit);
  near = few_steps(question, flight);
  Vector miss = map.miss(flight, x);
  const KeptEnergy energy(system, question, orbit.start);
  double energy_scale = 1;  // how much the energy changes as far as the motion goes
  const auto residual_of = [&](const Vector& missed, const Flight& of, const Vector& at) {
    return std::max(map.relative(missed, of),
                    std::abs(energy.miss({guess.t, at.head(n), at.tail(n)})) / energy_scale);
  };
  orbit.residual = map.relative(miss, flight);
  const Vector first = x;
  // Symmetries make families of orbits: what the derivative's error hides is left as it is.
  const double undetermined = question.is_free
                                  ? 10 * derivative_error
                                  : std::numeric_limits<double>::epsilon() * static_cast<double>(unknowns);
  Vector across = Vector::Zero(2 * n);
  std::string stopped;  // why a motion on the last line searched was
  for (int i = 0; i < most_corrections_of_orbit && orbit.residual > 0; ++i) {
    if (i > 0) chart.emplace(system, State{guess.t, x.head(n), x.tail(n)});
    const auto D = for_newton(map, *chart, orbit.period, flight);
    if (!D) break;
    const Index equations = unknowns + (energy.is_kept() ? 1 : 0);
    Matrix J = Matrix::Zero(equations, unknowns);
    Vector right = Vector::Zero(equations);
    J.topLeftCorner(size, size) = *D - Matrix::Identity(size, size);
    right.head(size) = -chart->along(miss);
    if (question.is_free) {
      if (i == 0) across = flight.rate;
      J.col(size).head(size) = chart->along(flight.rate);
      for (Index k = 0; k < size; ++k) J(size, k) = across.dot(chart->direction(k));
      right[size] = -across.dot(x - first);
    }
    if (energy.is_kept()) {
      const double farthest = flight.largest.maxCoeff();
      const Vector slope = energy.slope(*chart, newton_step * farthest);
      energy_scale = std::max(slope.norm() * farthest, std::numeric_limits<double>::min());
      J.row(size + 1).head(size) = slope.transpose();
      right[size + 1] = -energy.miss({guess.t, x.head(n), x.tail(n)});
      orbit.residual = residual_of(miss, flight, x);
    }
    const Vector step = convex::linear_algebra::CompleteOrthogonal(J, undetermined).solve(right);
    bool is_better = false;
    stopped.clear();
    for (double part = 1; part > shortest_part && !is_better; part *= 0.5) {
      const Vector next = chart->state_of(part * step.head(size));
      const double period = orbit.period + (question.is_free ? part * step[size] : 0);
      if (!(period >= shortest && period <= longest)) continue;
      Flight tried = map.fly(next, period);
      if (!tried.arrives) {
        if (stopped.empty() && !tried.pieces.empty()) stopped = tried.why;
        continue;
      }
      const Vector missed = map.miss(tried, next);
      const double residual = residual_of(missed, tried, next);
      if (!(residual < (1 - 0.1 * part) * orbit.residual)) continue;
      is_better = true;
      x = next;
      orbit.period = period;
      flight = std::move(tried);
      miss = missed;
      orbit.residual = residual;
    }
    if (!is_better) break;
  }
  orbit.start.q = x.head(n);
  orbit.start.v = x.tail(n);
  if (!(orbit.residual <= met)) {
    orbit.why = "Newton's method finds no motion near this state that comes back; begin nearer to one";
    if (!stopped.empty()) orbit.why += ". Those that it tries do not go on: " + stopped;
    if (std::string lost = lost_energy(system, near.motion, flight.events()); !lost.empty()) orbit.why = lost;
    return orbit;
  }
  orbit.why = why_not_repeated(system, near, map, flight, x, orbit.period);
  if (!orbit.why.empty()) return orbit;
  if (!is_driven_alike(system, guess, near, flight.end - miss, orbit.period))
    orbit.why = "the motion that comes back after " + number_text(orbit.period) +
                " does not do so again, for this is neither a period of what drives it nor a multiple of "
                "one; give one, as "
                "an expression such as \"2*pi/w\"";
  if (question.is_free && is_at_rest(flight, x, miss))
    orbit.why =
        "the motion that comes back is at rest: an equilibrium, which has no period; begin at a motion that "
        "goes around";
  if (!orbit.why.empty()) return orbit;
  orbit.is_found = true;
  note_passage(flight, system, orbit);
  for (const MotionEvent& event : flight.events()) {
    if (event.kind == EventKind::impact) orbit.impacts.push_back(event);
    if (event.kind == EventKind::accumulation)
      orbit.accumulating.insert(orbit.accumulating.end(), event.constraints.begin(), event.constraints.end());
  }
  chart.emplace(system, State{guess.t, x.head(n), x.tail(n)});
  const FlowDerivative D = for_multipliers(map, *chart, orbit.period, flight);
  if (D.kind != FlowDerivative::Kind::known) return orbit;
  orbit.multipliers = convex::linear_algebra::complex_eigenvalues(D.value);
  orbit.circle_width = circle_width(*orbit.multipliers, D);
  const auto others = multipliers_across(orbit, question.is_free);
  orbit.is_stable = std::all_of(others.begin(), others.end(),
                                [&](const auto& m) { return std::abs(m) < 1 - orbit.circle_width; });
  orbit.is_neutral = !orbit.is_stable && std::none_of(others.begin(), others.end(), [&](const auto& m) {
    return std::abs(m) > 1 + orbit.circle_width;
  });
  return orbit;
}

}  // namespace

std::vector<std::complex<double>> multipliers_across(const Orbit& orbit, bool is_free) {
  std::vector<std::complex<double>> others = *orbit.multipliers;
  if (is_free && !others.empty())
    others.erase(std::min_element(others.begin(), others.end(), [](const auto& a, const auto& b) {
      return std::abs(a - 1.0) < std::abs(b - 1.0);
    }));
  return others;
}

Orbit find_orbit(const LagrangianSystem& system, const State& first, const OrbitQuestion& question) {
  if (question.is_free && system.equations_of_motion().series.steps.uses_time)
    throw convex::InvalidInput(
        "an orbit of unknown period belongs to a system without t, which here stands in the expressions: the "
        "same state at another time goes on otherwise; give the period of what drives it, or a multiple");
  if (const auto n = static_cast<Index>(system.coordinates().size());
      question.modulo.size() != 0 && question.modulo.size() != n)
    throw convex::InvalidInput("modulo: " + convex::counted(question.modulo.size(), "entry", "entries") +
                               "; give " + std::to_string(n) + ", one per coordinate, or none");
  const State guess = not_penetrated(system, first, question);
  Orbit orbit = find_orbit_there(system, guess, question);
  const bool is_hidden =
      !orbit.is_found || (!orbit.multipliers && orbit.start_margin < near_start * orbit.period);
  if (!is_hidden || orbit.quiet.q.size() == 0 || !(orbit.quiet_margin > orbit.start_margin)) return orbit;
  OrbitQuestion there = question;
  if (question.is_free) there.period = orbit.period;
  const Orbit other = find_orbit_there(system, orbit.quiet, there);
  if (!other.is_found || (orbit.is_found && !other.multipliers)) return orbit;
  return orbit_from(system, other, question, guess.t);
}

}  // namespace mechanics::inline motions
