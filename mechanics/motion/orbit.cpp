#include "mechanics/motion/orbit.hpp"

#include <algorithm>
#include <cmath>

#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "convex/linear_algebra/complex_eigenvalues.hpp"
#include "mechanics/motion/tangent_chart.hpp"

namespace mechanics {
namespace {

using convex::Matrix;

constexpr int most_iterations = 60;

/// The start is met when it is missed by less than this part of how far the motion goes.
constexpr double met = 1e-10;

/// Steps of differences, relative to how far the motion goes: of the second order for Newton's method, of the
/// eighth for the multipliers; shorter ones where the events on the way change.
constexpr double newton_step = 1e-6, multiplier_step = 1e-3, shortest_step = 1e-7;
constexpr int multiplier_levels = 4;

/// Points of an arc that are looked at when a return is searched for.
constexpr int looks_per_arc = 16;

/// A free period is searched for within so many steps.
constexpr long most_steps_to_return = 20'000;

struct Flight {
  bool arrives = false;
  std::string why;
  Vector end;   // q and v: 2n
  Vector rate;  // v and q''
  std::vector<MotionEvent> events;
  Vector largest;  // how far each of q and v goes on the way
};

Vector joined(const Vector& q, const Vector& v) {
  Vector x(q.size() + v.size());
  x << q, v;
  return x;
}

/// The map over a period.
class PeriodMap {
 public:
  PeriodMap(const LagrangianSystem& system, double t, const OrbitQuestion& question)
      : system_(system), t_(t), question_(question) {}

  Flight fly(const Vector& x, double period) const {
    Flight flight;
    const Index n = x.size() / 2;
    flight.largest = x.cwiseAbs();
    try {
      Motion motion(system_, {t_, x.head(n), x.tail(n)}, question_.motion);
      flight.events = motion.events();
      while (motion.advance(t_ + period)) {
        flight.events.insert(flight.events.end(), motion.events().begin(), motion.events().end());
        flight.largest = flight.largest.cwiseMax(joined(motion.state().q, motion.state().v).cwiseAbs());
      }
      flight.arrives = motion.status() == MotionStatus::done && motion.state().t >= t_ + period;
      flight.why = motion.why();
      flight.end = joined(motion.state().q, motion.state().v);
      if (flight.arrives) flight.rate = joined(motion.state().v, motion.acceleration());
    } catch (const convex::InvalidInput& error) {
      flight.why = error.what();
    }
    return flight;
  }

  /// By how much the end misses the start.
  Vector miss(const Flight& flight, const Vector& x) const {
    Vector difference = flight.end - x;
    for (Index i = 0; i < question_.modulo.size(); ++i)
      if (question_.modulo[i] > 0)
        difference[i] -= question_.modulo[i] * std::round(difference[i] / question_.modulo[i]);
    return difference;
  }

  /// ∂end/∂y in the coordinates of a chart by central differences of order 2 times `levels`, extrapolated
  /// (Richardson); none if a motion on the way has other events, unless `at_any_rate`.
  std::optional<Matrix> derivative(const TangentChart& chart, double period, const Flight& flight,
                                   double step, int levels, bool at_any_rate) const {
    const Index size = chart.dimension();
    Matrix D(size, size);
    for (Index k = 0; k < size; ++k) {
      double part = 0;  // of what the motion goes, by a unit of this coordinate
      const Vector direction = chart.direction(k);
      for (Index i = 0; i < direction.size(); ++i)
        part = std::max(part, std::abs(direction[i]) / std::max(flight.largest[i], least_scale(flight)));
      const auto beside = [&](double by) -> std::optional<Vector> {
        const Flight other = fly(chart.state_of(by * Vector::Unit(size, k)), period);
        if (!other.arrives || (!at_any_rate && !alike(other.events, flight.events))) return std::nullopt;
        return other.end;
      };
      std::vector<Vector> slopes;  // with h, 2h, 4h, …
      double h = step / part;
      for (int level = 0; level < levels; ++level, h *= 2) {
        const auto right = beside(h), left = beside(-h);
        if (!right || !left) return std::nullopt;
        slopes.push_back((*right - *left) / (2 * h));
      }
      double factor = 4;
      for (std::size_t left = slopes.size(); left > 1; --left, factor *= 4)
        for (std::size_t j = 0; j + 1 < left; ++j) slopes[j] += (slopes[j] - slopes[j + 1]) / (factor - 1);
      D.col(k) = chart.along(slopes[0]);
    }
    return D;
  }

  static double least_scale(const Flight& flight) { return 1e-3 * flight.largest.maxCoeff(); }

 private:
  /// The same events in the same order; repetitions, of which an accumulation has more or fewer, count once.
  static bool alike(const std::vector<MotionEvent>& a, const std::vector<MotionEvent>& b) {
    const auto same = [](const MotionEvent& x, const MotionEvent& y) {
      return x.kind == y.kind && x.constraints == y.constraints;
    };
    const auto without_repetitions = [&](std::vector<MotionEvent> events) {
      events.erase(std::unique(events.begin(), events.end(), same), events.end());
      return events;
    };
    const auto x = without_repetitions(a), y = without_repetitions(b);
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), same);
  }

  const LagrangianSystem& system_;
  double t_;
  const OrbitQuestion& question_;
};

/// The largest of |miss| over how far the motion goes.
double relative(const Vector& miss, const Flight& flight) {
  double worst = 0;
  for (Index i = 0; i < miss.size(); ++i)
    worst = std::max(worst, std::abs(miss[i]) / std::max(flight.largest[i], PeriodMap::least_scale(flight)));
  return worst;
}

/// The time after which the motion comes back to the plane through x across its direction, in that direction,
/// nearer to x than half of how far it was away; 0 if it does not.
double return_time(const LagrangianSystem& system, const State& guess, const MotionOptions& options) {
  Motion motion(system, guess, options);
  const Vector x = joined(guess.q, guess.v), direction = joined(guess.v, motion.acceleration());
  double farthest = 0, last = 0;
  bool was_behind = false;
  for (long step = 0; step < most_steps_to_return; ++step) {
    // Without an end in time a step goes as far as its series or an event; a motion without either has no
    // return.
    if (!motion.advance(guess.t + 1e9)) return 0;
    const Arc& arc = motion.arc();
    for (int k = 1; k <= looks_per_arc; ++k) {
      const double tau = arc.length * k / looks_per_arc;
      const Vector away = joined(arc.position(tau), arc.velocity(tau)) - x;
      const double along = away.dot(direction);
      farthest = std::max(farthest, away.norm());
      const double time = arc.t - guess.t + tau;
      if (was_behind && along >= 0 && away.norm() < 0.5 * farthest) return 0.5 * (time + last);
      was_behind = along < 0;
      last = time;
    }
  }
  return 0;
}

}  // namespace

Orbit find_orbit(const LagrangianSystem& system, const State& guess, const OrbitQuestion& question) {
  Orbit orbit;
  std::optional<TangentChart> chart(std::in_place, system, guess);
  orbit.start = chart->origin();
  orbit.period = question.period;
  if (question.is_free && !(orbit.period > 0))
    orbit.period = return_time(system, orbit.start, question.motion);
  if (!(orbit.period > 0)) {
    orbit.why = "the motion from the state of the file does not come near it again";
    return orbit;
  }
  const PeriodMap map(system, guess.t, question);
  const Index n = guess.q.size(), size = chart->dimension(), unknowns = size + (question.is_free ? 1 : 0);
  Vector x = joined(orbit.start.q, orbit.start.v);
  Flight flight = map.fly(x, orbit.period);
  if (!flight.arrives) {
    orbit.why = flight.why;
    return orbit;
  }
  Vector miss = map.miss(flight, x);
  orbit.residual = relative(miss, flight);
  const Vector first = x;
  Vector across = Vector::Zero(2 * n);
  for (int i = 0; i < most_iterations && orbit.residual > 0; ++i) {
    if (i > 0) chart.emplace(system, State{guess.t, x.head(n), x.tail(n)});
    auto D = map.derivative(*chart, orbit.period, flight, newton_step, 1, false);
    if (!D) D = map.derivative(*chart, orbit.period, flight, newton_step, 1, true);
    if (!D) break;
    Matrix J = Matrix::Zero(unknowns, unknowns);
    Vector right = Vector::Zero(unknowns);
    J.topLeftCorner(size, size) = *D - Matrix::Identity(size, size);
    right.head(size) = -chart->along(miss);
    if (question.is_free) {
      if (i == 0) across = flight.rate;
      J.col(size).head(size) = chart->along(flight.rate);
      for (Index k = 0; k < size; ++k) J(size, k) = across.dot(chart->direction(k));
      right[size] = -across.dot(x - first);
    }
    const Vector step = convex::linear_algebra::CompleteOrthogonal(J).solve(right);
    bool is_better = false;
    for (double part = 1; part > 1e-4 && !is_better; part *= 0.5) {
      const Vector next = chart->state_of(part * step.head(size));
      const double period = orbit.period + (question.is_free ? part * step[size] : 0);
      if (!(period > 0)) continue;
      Flight tried = map.fly(next, period);
      if (!tried.arrives) continue;
      const Vector missed = map.miss(tried, next);
      const double residual = relative(missed, tried);
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
    orbit.why =
        "Newton's method from the state of the file finds no motion that comes back; give a nearer one";
    return orbit;
  }
  orbit.is_found = true;
  for (const MotionEvent& event : flight.events)
    if (event.kind == EventKind::impact) orbit.impacts.push_back(event);
  chart.emplace(system, State{guess.t, x.head(n), x.tail(n)});
  for (double step = multiplier_step; step > shortest_step && !orbit.multipliers; step *= 0.25)
    if (const auto D = map.derivative(*chart, orbit.period, flight, step, multiplier_levels, false))
      orbit.multipliers = convex::linear_algebra::complex_eigenvalues(*D);
  if (!orbit.multipliers) return orbit;
  std::vector<std::complex<double>> others = *orbit.multipliers;
  if (question.is_free)
    others.erase(std::min_element(others.begin(), others.end(), [](const auto& a, const auto& b) {
      return std::abs(a - 1.0) < std::abs(b - 1.0);
    }));
  orbit.is_stable = std::all_of(others.begin(), others.end(), [](const auto& m) { return std::abs(m) < 1; });
  return orbit;
}

}  // namespace mechanics
