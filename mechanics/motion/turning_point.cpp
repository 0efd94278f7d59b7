#include "mechanics/motion/turning_point.hpp"

#include <algorithm>
#include <cmath>

#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/motion/period_map.hpp"

namespace mechanics::inline motions {
namespace {

using convex::Matrix;

constexpr int most_turning_steps = 20;

/// Steps of differences, as parts of how far things go.
constexpr double difference_part = 1e-5;

/// Newton's method has arrived when the parameter moves by less than this part of its size, and an orbit is
/// one when it misses its start by less than the other. Where rounding lets it come no nearer, ten digits of
/// the parameter are told.
constexpr double settled_value = 1e-12, met_part = 1e-10, told_value = 1e-10;

/// Of an orbit beside a fold, its distance is met to this part: which orbit it is, no more.
constexpr double met_distance = 1e-6;

/// A parameter, or a coordinate, nearer to 0 than this part of how far it goes counts as so large.
constexpr double part_of_range = 1e-3;

/// Where an orbit is looked for: the state at its start and its period, which is an unknown where it is free.
/// Of the states along a free orbit, the one across the motion from the first counts.
struct Place {
  Vector x;
  double period = 0;
};
struct Phase {
  Vector across, x;
};

/// What a value and a place of the family tell.
struct Look {
  std::unique_ptr<const LagrangianSystem> system;
  OrbitQuestion question;
  std::optional<TangentChart> chart;
  std::optional<PeriodMap> map;
  Flight flight;
  Place place;
  Vector miss;  // in the chart, and of the phase if the period is free
  double residual = 0;

  Index dimension() const { return chart->dimension(); }
  Index unknowns() const { return dimension() + (question.is_free ? 1 : 0); }
  /// From here, by a step of the unknowns.
  Place beside(const Vector& step) const {
    return {chart->state_of(step.head(dimension())),
            place.period + (question.is_free ? step[dimension()] : 0)};
  }
};

/// In place: a map refers to its question.
bool look(const OrbitFamily& family, double value, double t, const Place& place, const Phase& phase,
          Look& at) {
  const Vector x = place.x;  // of `at` itself, it may be
  const double period = place.period;
  const Index n = x.size() / 2;
  try {
    at.map.reset();
    at.chart.reset();
    at.system = family.system(value);
    at.question = family.question(*at.system, value);
    if (at.question.is_free) at.question.period = period;
    at.chart.emplace(*at.system, State{t, x.head(n), x.tail(n)});
    at.map.emplace(*at.system, t, at.question);
  } catch (const convex::InvalidInput&) {
    return false;
  }
  if (!(at.question.period > 0)) return false;
  at.place = {as_one(at.chart->origin()), at.question.period};
  at.flight = at.map->fly(at.place.x, at.place.period);
  if (!at.flight.arrives) return false;
  const Vector missed = at.map->miss(at.flight, at.place.x);
  at.miss.resize(at.unknowns());
  at.miss.head(at.dimension()) = at.chart->along(missed);
  if (at.question.is_free) at.miss[at.dimension()] = phase.across.dot(at.place.x - phase.x);
  at.residual = at.map->relative(missed, at.flight);
  return true;
}

std::optional<Matrix> jacobian(const Look& at, const Phase& phase) {
  const FlowDerivative D = at.map->derivative(*at.chart, at.flight);
  if (D.kind != FlowDerivative::Kind::known) return std::nullopt;
  const Index size = at.dimension();
  Matrix J = Matrix::Zero(at.unknowns(), at.unknowns());
  J.topLeftCorner(size, size) = D.value - Matrix::Identity(size, size);
  if (!at.question.is_free) return J;
  J.col(size).head(size) = at.chart->along(at.flight.rate);
  for (Index k = 0; k < size; ++k) J(size, k) = phase.across.dot(at.chart->direction(k));
  return J;
}

Matrix bordered(const Matrix& J, const Vector& b, const Vector& c) {
  const Index size = J.rows();
  Matrix all = Matrix::Zero(size + 1, size + 1);
  all.topLeftCorner(size, size) = J;
  all.col(size).head(size) = b;
  all.row(size).head(size) = c.transpose();
  return all;
}

/// g, and v, which becomes the direction of the branch.
Vector null_vector(const Matrix& J, const Vector& b, const Vector& c) {
  return convex::linear_algebra::CompleteOrthogonal(bordered(J, b, c))
      .solve(Vector::Unit(J.rows() + 1, J.rows()));
}

double size_of(double value, const OrbitFamily& family) {
  return std::max(std::abs(value), part_of_range * family.range);
}

double step_of_value(double value, const OrbitFamily& family) {
  return difference_part * size_of(value, family);
}

/// ∂map/∂p by central differences.
std::optional<Vector> by_parameter(const OrbitFamily& family, double value, const Phase& phase,
                                   const Look& at) {
  const double h = step_of_value(value, family), t = at.chart->origin().t;
  Look right, left;
  if (!look(family, value + h, t, at.place, phase, right) ||
      !look(family, value - h, t, at.place, phase, left))
    return std::nullopt;
  const Vector moved = at.map->miss(right.flight, right.place.x) - at.map->miss(left.flight, left.place.x);
  Vector by = Vector::Zero(at.unknowns());
  by.head(at.dimension()) = at.chart->along(moved) / (2 * h);
  return by;
}

/// Where g = 0 is looked for from: the singular vectors of J for its least singular value.
struct Borders {
  Vector b, c;
};

Borders borders(const Matrix& J) {
  // Powers of (J Jᵀ)⁻¹ and (JᵀJ)⁻¹.
  const Index size = J.rows();
  const convex::linear_algebra::CompleteOrthogonal solve(J, 0), transposed(J.transpose(), 0);
  Borders found{Vector::Ones(size).normalized(), Vector::Ones(size).normalized()};
  constexpr int enough_powers = 20;
  for (int k = 0; k < enough_powers; ++k) {
    const Vector c = solve.solve(found.b);
    if (c.norm() > 0) found.c = c.normalized();
    const Vector b = transposed.solve(found.c);
    if (b.norm() > 0) found.b = b.normalized();
  }
  return found;
}

/// By definition a fold has the multiplier 1; what Newton's method met otherwise is none.
bool has_multiplier_one(const Orbit& orbit, bool is_free) {
  constexpr double near_one = 1e-3;
  for (const auto& m : multipliers_across(orbit, is_free))
    if (std::abs(m - 1.0) <= near_one) return true;
  return false;
}

/// Orbits of free period by their energy have two multipliers 1 everywhere.
bool may_keep_energy(const LagrangianSystem& system) {
  const std::vector<expression::NodeId>& forces = system.model().forces;
  return std::all_of(forces.begin(), forces.end(),
                     [](expression::NodeId Q) { return Q == expression::no_node; });
}

Phase phase_at(const Look& at) { return {at.flight.rate, at.place.x}; }

}  // namespace

std::optional<TurningPoint> find_turning_point(const OrbitFamily& orbits, double value, const Orbit& near,
                                               double reach) {
  const double t = near.start.t, first = value;
  const Place start{as_one(near.start), near.period};
  Look at;
  if (!look(orbits, value, t, start, {Vector::Zero(start.x.size()), start.x}, at)) return std::nullopt;
  const OrbitFamily family{orbits.system,
                           [&orbits, flight = at.flight](const LagrangianSystem& system, double p) {
                             return few_steps(orbits.question(system, p), flight);
                           },
                           orbits.range};
  if (at.question.is_free && may_keep_energy(*at.system)) return std::nullopt;
  const Phase phase = phase_at(at);
  auto J = jacobian(at, phase);
  if (!J) return std::nullopt;
  const Index size = J->rows();
  const auto [b, c] = borders(*J);
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_turning_steps; ++k) {
    const Vector v = null_vector(*J, b, c);
    const auto F_p = by_parameter(family, value, phase, at);
    if (!F_p) return std::nullopt;
    // The extended system's derivative: g by differences.
    Matrix all = bordered(*J, *F_p, Vector::Zero(size));
    const auto g_at = [&, &b = b, &c = c](double p, const Place& place) -> std::optional<double> {
      Look there;
      if (!look(family, p, t, place, phase, there)) return std::nullopt;
      const auto of = jacobian(there, phase);
      if (!of || of->rows() != size) return std::nullopt;
      return null_vector(*of, b, c)[size];
    };
    const double scale = part_of_range * at.flight.largest.maxCoeff();
    for (Index i = 0; i <= size; ++i) {
      double h = step_of_value(value, family);
      std::optional<double> right, left;
      if (i == size) {
        right = g_at(value + h, at.place);
        left = g_at(value - h, at.place);
      } else if (i == at.dimension()) {  // the period
        h = difference_part * at.place.period;
        right = g_at(value, at.beside(h * Vector::Unit(size, i)));
        left = g_at(value, at.beside(-h * Vector::Unit(size, i)));
      } else {
        const Vector direction = at.chart->direction(i);
        double part = 0;
        for (Index j = 0; j < direction.size(); ++j)
          part = std::max(part, std::abs(direction[j]) / std::max(at.flight.largest[j], scale));
        h = difference_part / part;
        right = g_at(value, at.beside(h * Vector::Unit(size, i)));
        left = g_at(value, at.beside(-h * Vector::Unit(size, i)));
      }
      if (!right || !left) return std::nullopt;
      all(size, i) = (*right - *left) / (2 * h);
    }
    Vector rest(size + 1);
    rest << -at.miss, -v[size];
    const Vector step = convex::linear_algebra::CompleteOrthogonal(all).solve(rest);
    const Place place = at.beside(step);
    const double moved = std::abs(step[size]);
    value += step[size];
    // Where there is no fold the parameter may double with each step, and the motions get ever longer.
    if (!(std::abs(value - first) <= reach) || !look(family, value, t, place, phase, at)) return std::nullopt;
    J = jacobian(at, phase);
    if (!J || J->rows() != size) return std::nullopt;
    const bool is_settled = moved <= settled_value * size_of(value, family);
    if (k > 0 && at.residual <= met_part &&
        (is_settled || (moved >= last && moved <= told_value * std::abs(value)))) {
      TurningPoint found;
      found.value = value;
      const Vector& x = at.place.x;
      const Index n = x.size() / 2;
      found.orbit = find_orbit(*at.system, {t, x.head(n), x.tail(n)}, at.question);
      if (!found.orbit.is_found || !found.orbit.multipliers) return std::nullopt;
      if (!has_multiplier_one(found.orbit, at.question.is_free)) return std::nullopt;
      found.orbit.is_stable = false;  // a multiplier is 1, but for rounding
      found.along = Vector::Zero(2 * n);
      for (Index i = 0; i < at.dimension(); ++i) found.along += v[i] * at.chart->direction(i);
      found.along.normalize();
      return found;
    }
    last = moved;
  }
  return std::nullopt;
}

std::optional<OrbitBeside> orbit_beside(const OrbitFamily& family, const TurningPoint& fold,
                                        double distance) {
  const Vector origin = as_one(fold.orbit.start);
  const double t = fold.orbit.start.t;
  double value = fold.value;
  Look at;
  const Phase none{Vector::Zero(origin.size()), origin};
  if (!look(family, value, t, {origin, fold.orbit.period}, none, at)) return std::nullopt;
  const Phase phase = phase_at(at);
  if (!look(family, value, t, {origin + distance * fold.along, fold.orbit.period}, phase, at))
    return std::nullopt;
  for (int k = 0; k < most_turning_steps; ++k) {
    const auto J = jacobian(at, phase);
    const auto F_p = by_parameter(family, value, phase, at);
    if (!J || !F_p) return std::nullopt;
    const Index size = J->rows();
    Vector onward = Vector::Zero(size), rest(size + 1);
    for (Index i = 0; i < at.dimension(); ++i) onward[i] = fold.along.dot(at.chart->direction(i));
    rest << -at.miss, distance - fold.along.dot(at.place.x - origin);
    const Vector step = convex::linear_algebra::CompleteOrthogonal(bordered(*J, *F_p, onward)).solve(rest);
    value += step[size];
    if (!std::isfinite(value) || !look(family, value, t, at.beside(step), phase, at)) return std::nullopt;
    const double away = std::abs(fold.along.dot(at.place.x - origin) - distance);
    if (at.residual <= met_part && away <= met_distance * std::abs(distance)) {
      const Vector& x = at.place.x;
      const Index n = x.size() / 2;
      OrbitBeside found{value, find_orbit(*at.system, {t, x.head(n), x.tail(n)}, at.question)};
      if (!found.orbit.is_found) return std::nullopt;
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace mechanics::inline motions
