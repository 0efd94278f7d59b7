#pragma once

#include <functional>
#include <vector>

#include "convex/gamma0/function.hpp"
#include "convex/laws/check.hpp"
#include "convex/laws/trial.hpp"

namespace convex::inline law_checks {

/// Roundings of a value of f, relative to the terms it is compared with.
inline constexpr double value_roundings = 64 * unit_roundoff;

/// A function on trial: its two verbs, whoever wrote it.
struct Subject {
  std::function<double(const Vector&)> value;
  std::function<Prox(const Vector&, const Metric&)> prox;
  /// How far outside its domain f still counts as finite, relative to the point: 0 for a function that is
  /// finite everywhere.
  double membership = membership_tolerance;
};

/// x = prox_f z with all that laws ask about it: v = W(z - x), f(x), and the bound on ||x - x*||_W, the
/// prox's own and its rounding.
struct Split {
  Vector z, x, v;
  double f_x = 0, bound = 0;
};
Split split(const Subject& f, const Vector& z, const Metric& W);

/// How much f may change when x moves by r in one coordinate, where it stays finite: what an error of r in x
/// does to f(x).
double variation(const Subject& f, const Vector& x, double r);

/// What is tried of a function known by value and prox alone. `others`: more points of the same space.
/// - f(x) is finite at x = prox_f z;
/// - z - x is a subgradient at x in the metric: f(u) >= f(x) + (z - x|u - x) for all u (Moreau 1965, 5.b);
/// - firm nonexpansiveness: ||x - x'||² <= (x - x'|z - z') (Moreau 1965, 5.c);
/// - one subgradient serves every metric: with v = W(z - x), x is also the prox of x + V⁻¹v in the metric V.
std::vector<Check> prox_laws(const Subject& f, const Trial& trial, const std::vector<Vector>& others);

}  // namespace convex::inline law_checks
