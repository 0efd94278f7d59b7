#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/functions/piecewise_sum.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/sets.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/prox_formulas/separable.hpp"

namespace convex::inline named_functions {
namespace {

void check(double lower, double upper, const std::string& entry) {
  if (std::isnan(lower) || std::isnan(upper))
    throw InvalidInput("box: a bound is not a number; give numbers");
  if (lower > upper || lower == infinity || upper == -infinity)
    throw InvalidInput("box: lower > upper" + entry + ", so the set is empty; give lower <= upper");
}

/// {lower <= x_i <= upper} for every entry.
Set equal_bounds(Call set, Call support, double lower, double upper) {
  const Function indicator = piecewise_sum(
      {.call = indicator_call(set),
       .conjugate_call = std::move(support),
       .pieces = {piecewise::indicator(lower, upper)},
       .prox = [lower, upper](const Vector& z,
                              const Vector&) { return prox_formulas::proj_box(z, lower, upper); },
       .form =
           [lower, upper](Index n) {
             return linear_quadratic::box(Vector::Constant(n, lower), Vector::Constant(n, upper));
           }});
  return {indicator, std::move(set)};
}

}  // namespace

Set box(double lower, double upper) {
  check(lower, upper, "");
  const Call set{"box", {argument("lower", lower), argument("upper", upper)}};
  return equal_bounds(set, support_call(set), lower, upper);
}

Set box(const Vector& lower, const Vector& upper) {
  if (lower.size() != upper.size() || lower.size() == 0)
    throw InvalidInput("box: lower has " + counted(lower.size(), "entry", "entries") + ", upper " +
                       std::to_string(upper.size()) + "; give as many, at least one");
  for (Index i = 0; i < lower.size(); ++i) check(lower[i], upper[i], " in entry " + std::to_string(i));
  const Call set{"box", {argument("lower", lower), argument("upper", upper)}};
  PiecewiseSum parts{
      .call = indicator_call(set),
      .conjugate_call = support_call(set),
      .pieces = {},
      .dimension = lower.size(),
      .prox = [lower, upper](const Vector& z,
                             const Vector&) { return prox_formulas::proj_box(z, lower, upper); },
      .form = [lower, upper](Index) { return linear_quadratic::box(lower, upper); }};
  for (Index i = 0; i < lower.size(); ++i) parts.pieces.push_back(piecewise::indicator(lower[i], upper[i]));
  return {piecewise_sum(std::move(parts)), set};
}

Set orthant() {
  const Call negative{"box", {argument("lower", -infinity), argument("upper", 0.0)}};
  return equal_bounds({"orthant"}, indicator_call(negative), 0, infinity);
}

Set ball_inf(double radius) {
  require_nonnegative("ball_inf", "radius", radius);
  return equal_bounds({"ball_inf", {argument("radius", radius)}}, {"norm1", {argument("weight", radius)}},
                      -radius, radius);
}

Set point(double p) {
  require_finite("point", "p", p);
  const Call set{"point", {argument("p", p)}};
  return equal_bounds(set, p == 0 ? Call{"zero"} : support_call(set), p, p);
}

Set point(const Vector& p) {
  require_entries("point", "p", p);
  const Call set{"point", {argument("p", p)}};
  PiecewiseSum parts{.call = indicator_call(set),
                     .conjugate_call = {"linear", {argument("c", p)}},
                     .pieces = {},
                     .dimension = p.size(),
                     .prox = [p](const Vector&, const Vector&) { return p; },
                     .form = [p](Index) { return linear_quadratic::point(p); },
                     .conjugate_form = [p](Index) { return linear_quadratic::linear(p); }};
  for (double entry : p) parts.pieces.push_back(piecewise::point(entry));
  return {piecewise_sum(std::move(parts)), set};
}

}  // namespace convex::inline named_functions
