#include "convex/composite/multiplier_step.hpp"

#include <cmath>
#include <limits>

#include "convex/composite/newton_system.hpp"
#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {
namespace {

constexpr double armijo = 1e-4;
constexpr int halvings = 50, most_hidden = 4;  ///< steps whose descent the slopes alone show
constexpr Index newton_limit = 100;
constexpr double floor_roundings = 16;

/// The inner problem at a ξ.
struct Inner {
  Vector xi, t, u, gradient, r;
  double value = 0;  ///< not a number where a term has no prox in doubles
  double size = 0;   ///< the sum of the absolute values of the parts of `value`
};

Inner inner_at(const SaddleProblem& problem, const SaddlePoint& centre, const Vector& D, const Vector& ridge,
               Vector xi) {
  Inner at;
  const Vector image = problem.M * xi + problem.b;
  at.t = image + centre.y.cwiseQuotient(D);
  at.u = prox_of_terms(problem, at.t, D);
  at.r = image - at.u;
  if (!at.u.allFinite()) at.value = std::numeric_limits<double>::quiet_NaN();
  const Vector y = D.cwiseProduct(at.t - at.u);
  const Vector x = xi.head(problem.n), w_step = xi.tail(problem.k) - centre.xi.tail(problem.k);
  const Vector covector = metric_difference(problem.W, x, problem.z);
  at.gradient = problem.c + problem.M.transpose() * y;
  at.gradient.head(problem.n) += covector;
  at.gradient.tail(problem.k) += ridge.cwiseProduct(w_step);
  const auto add = [&](double part) {
    at.value += part;
    at.size += std::abs(part);
  };
  if (problem.Q.size() > 0) {
    const Vector image_of_Q = problem.Q * xi;
    at.gradient += image_of_Q;
    add(0.5 * xi.dot(image_of_Q));
  }
  add(0.5 * covector.dot(x - problem.z));
  add(problem.c.dot(xi));
  add(0.5 * ridge.dot(w_step.cwiseAbs2()));
  add(0.5 * y.dot(at.t - at.u));
  for (const SaddleTerm& term : problem.terms)
    if (!std::isnan(at.value)) add(term.scale * term.f->value(at.u.segment(term.first, term.rows)));
  at.xi = std::move(xi);
  return at;
}

/// What the rounding of D(t - u) may be of the slope along a direction.
double rounding_of_slope(const SaddleProblem& problem, const Inner& at, const Vector& D,
                         const Vector& direction) {
  constexpr double roundings = 4;
  const Vector moved = problem.M.cwiseAbs() * direction.cwiseAbs();
  return roundings * unit_roundoff * moved.dot(D.cwiseProduct(at.t.cwiseAbs() + at.u.cwiseAbs()));
}

}  // namespace

MultiplierStep multiplier_step(const SaddleProblem& problem, const SaddlePoint& centre, const Vector& D,
                               const Vector& ridge, double accuracy) {
  MultiplierStep result;
  Inner at = inner_at(problem, centre, D, ridge, centre.xi);
  const Vector no_r = Vector::Zero(problem.m);
  int hidden_steps = 0;
  for (; result.newton_steps < newton_limit && !WorkLimit::passed(); ++result.newton_steps) {
    if (std::isnan(at.value)) break;
    const NewtonSystem system(problem, at.t, D, 1, ridge);
    if (!system.usable()) break;
    const Vector direction = system.step(at.gradient, no_r).dxi;
    const double slope = at.gradient.dot(direction);
    const double decrement = std::sqrt(std::max(0.0, -slope));
    const double noise = floor_roundings * unit_roundoff * at.size;
    const double moved = D.cwiseSqrt().cwiseProduct(at.r).norm();
    if (decrement <= std::max(accuracy * moved, unit_roundoff * std::sqrt(at.size))) {
      result.minimised = true;
      break;
    }
    bool accepted = false, hidden = false;
    double length = 1;
    const auto try_length = [&] {
      ++result.evaluations;
      WorkLimit::count(WorkLimit::of_a_saddle_point);
      return inner_at(problem, centre, D, ridge, at.xi + length * direction);
    };
    double low = 0, high = 0;
    for (int halving = 0; halving < halvings && !accepted && !hidden; ++halving) {
      Inner next = try_length();
      const double change = next.value - at.value;
      accepted = change <= armijo * length * slope;
      // Where rounding hides the descent of the value, the gradient still shows it.
      hidden = !accepted && std::abs(change) <= noise;
      if (hidden && length == 1)
        accepted = next.gradient.dot(system.step(next.gradient, no_r).dxi) > 0.25 * slope;
      if (!hidden || next.gradient.dot(direction) > 0) high = length;
      if (accepted) at = std::move(next);
      length /= 2;
    }
    // The slope along the direction grows, and beyond a kink is one of ascent.
    const bool by_slopes = hidden && !accepted && high > 0 &&
                           -slope > rounding_of_slope(problem, at, D, direction) &&
                           hidden_steps++ < most_hidden;
    for (int halving = 0; halving < halvings && by_slopes && !accepted; ++halving) {
      length = 0.5 * (low + high);
      Inner next = try_length();
      const double next_slope = next.gradient.dot(direction);
      (next_slope < 0 ? low : high) = length;
      accepted = std::abs(next_slope) <= -0.5 * slope;
      if (accepted) at = std::move(next);
    }
    if (!accepted) break;
  }
  result.gap = at.r;
  result.point = saddle_point(problem, at.xi, at.t, D);
  return result;
}

}  // namespace convex::inline composite
