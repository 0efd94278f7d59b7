#include "convex/functions/piecewise_functions.hpp"

#include "convex/functions/piecewise_sum.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/sets.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/pieces.hpp"
#include "convex/prox_formulas/separable.hpp"

namespace convex::inline named_functions {
namespace {

using linear_quadratic::ball_inf;

Call at_zero() { return indicator_call({"point", {argument("p", 0.0)}}); }

/// With a conjugate that has no other name than the plq of its pieces.
Function unnamed_conjugate(Call call, const PiecewiseQuadratic& f,
                           std::function<Vector(const Vector&, const Vector&)> prox,
                           std::function<LinearQuadratic(Index)> form) {
  return piecewise_sum({.call = std::move(call),
                        .conjugate_call = plq_call(conjugate(f)),
                        .pieces = {f},
                        .prox = std::move(prox),
                        .form = std::move(form)});
}

}  // namespace

Function zero() {
  return piecewise_sum({.call = {"zero"}, .conjugate_call = at_zero(), .pieces = {piecewise::constant(0)}});
}

Function constant(double c) {
  require_finite("constant", "c", c);
  const Call conjugate{"sum", {argument(at_zero()), argument(Call{"constant", {argument("c", -c)}})}};
  return piecewise_sum({.call = {"constant", {argument("c", c)}},
                        .conjugate_call = conjugate,
                        .pieces = {piecewise::constant(0)},
                        .offset = c});
}

Function linear(const Vector& c) {
  require_entries("linear", "c", c);
  PiecewiseSum parts{
      .call = {"linear", {argument("c", c)}},
      .conjugate_call = indicator_call({"point", {argument("p", c)}}),
      .pieces = {},
      .dimension = c.size(),
      .prox = [c](const Vector& z, const Vector& d) -> Vector { return z - c.cwiseQuotient(d); },
      .form = [c](Index) { return linear_quadratic::linear(c); },
      .conjugate_form = [c](Index) { return linear_quadratic::point(c); }};
  for (double slope : c) parts.pieces.push_back(piecewise::linear(slope));
  return piecewise_sum(std::move(parts));
}

Function norm1(double weight) {
  require_nonnegative("norm1", "weight", weight);
  return piecewise_sum(
      {.call = {"norm1", {argument("weight", weight)}},
       .conjugate_call = indicator_call({"ball_inf", {argument("radius", weight)}}),
       .pieces = {piecewise::absolute(weight)},
       .prox = [weight](const Vector& z,
                        const Vector& d) { return prox_formulas::prox_norm1(z, weight / d.array()); },
       .form = [weight](Index n) { return linear_quadratic::norm1(n, weight); },
       .conjugate_form = [weight](Index n) { return ball_inf(n, weight); }});
}

Function norm1(const Vector& weight) {
  require_nonnegative("norm1", "weight", weight);
  const Call box{"box", {argument("lower", Vector(-weight)), argument("upper", weight)}};
  PiecewiseSum parts{.call = {"norm1", {argument("weight", weight)}},
                     .conjugate_call = indicator_call(box),
                     .pieces = {},
                     .dimension = weight.size(),
                     .prox = [weight](const Vector& z, const Vector& d) {
                       return prox_formulas::prox_norm1(z, weight.cwiseQuotient(d));
                     }};
  for (double one : weight) parts.pieces.push_back(piecewise::absolute(one));
  return piecewise_sum(std::move(parts));
}

Function squared_norm2(double weight) {
  require_nonnegative("squared_norm2", "weight", weight);
  if (weight > 0 && !std::isfinite(1 / weight))
    throw InvalidInput("squared_norm2(weight): its inverse is not a number; give 0 or a larger one");
  return piecewise_sum(
      {.call = {"squared_norm2", {argument("weight", weight)}},
       .conjugate_call = weight > 0 ? Call{"squared_norm2", {argument("weight", 1 / weight)}} : at_zero(),
       .pieces = {piecewise::quadratic(weight)},
       .form = [weight](Index n) { return linear_quadratic::squared_norm2(n, weight); }});
}

Function huber(double mu) {
  require_positive("huber", "mu", mu);
  return unnamed_conjugate(
      {"huber", {argument("mu", mu)}}, piecewise::huber(mu),
      [mu](const Vector& z, const Vector& d) { return prox_formulas::prox_huber(z, mu, d.cwiseInverse()); },
      [mu](Index n) { return linear_quadratic::huber(n, mu); });
}

Function hinge() {
  return unnamed_conjugate(
      {"hinge"}, piecewise::hinge(),
      [](const Vector& z, const Vector& d) { return prox_formulas::prox_hinge(z, d.cwiseInverse()); },
      linear_quadratic::hinge);
}

Function squared_hinge() {
  return unnamed_conjugate(
      {"squared_hinge"}, piecewise::squared_hinge(2),
      [](const Vector& z, const Vector& d) { return prox_formulas::prox_squared_hinge(z, 2 / d.array()); },
      linear_quadratic::squared_hinge);
}

Function elastic_net(double l1, double l2) {
  require_nonnegative("elastic_net", "l1", l1);
  require_nonnegative("elastic_net", "l2", l2);
  return unnamed_conjugate(
      {"elastic_net", {argument("l1", l1), argument("l2", l2)}}, piecewise::elastic_net(l1, l2),
      [l1, l2](const Vector& z, const Vector& d) {
        return prox_formulas::prox_elastic_net(z, l1 / d.array(), l2 / d.array());
      },
      [l1, l2](Index n) { return linear_quadratic::elastic_net(n, l1, l2); });
}

Function pinball(double tau) {
  require_finite("pinball", "tau", tau);
  if (tau < 0 || tau > 1)
    throw InvalidInput("pinball(tau): not between 0 and 1; the function would be -inf somewhere below 0");
  const Call box{"box", {argument("lower", tau - 1), argument("upper", tau)}};
  return piecewise_sum({.call = {"pinball", {argument("tau", tau)}},
                        .conjugate_call = indicator_call(box),
                        .pieces = {piecewise_quadratic(Vector{{0}}, Matrix{{0, tau - 1, 0}, {0, tau, 0}})}});
}

Function plq(const Vector& breaks, const Matrix& coefficients) {
  const PiecewiseQuadratic p = piecewise_quadratic(breaks, coefficients);
  return unnamed_conjugate({"plq", {argument("breaks", breaks), argument("coefficients", coefficients)}}, p,
                           {}, {});
}

}  // namespace convex::inline named_functions
