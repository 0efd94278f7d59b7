#include "convex/linear_quadratic/polish.hpp"

#include <cmath>
#include <limits>

#include "convex/linear_quadratic/stationarity.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::linear_quadratic {
namespace {

using Set = WorkingSet;

constexpr int most_corrections = 30;

/// Corrections that shrink less than this are no longer worth their while.
constexpr double slowest_gain = 0.25;

/// Corrections end when x moves by less than this part of ||z||_W + ||x||_W, near the end of twice the
/// precision, so that zeros among the multipliers show; and where they no longer shrink, the second will do.
constexpr double enough = 0x1p-92, will_do = 0x1p-60;

/// An entry of the subgradient below this part of its terms cannot be told from 0.
constexpr double v_noise = 0x1p-64;

/// The move to one row may lead across others.
constexpr double outside_safety = 2;

/// Negative multipliers up to this part of the largest change are rounding about 0.
constexpr double sign_noise = 1e-10;

/// An entry no larger than its last correction is 0 to the last digit that can be told.
void drop_noise(DoubleDoubleVector& x, const Vector& correction) {
  for (Index i = 0; i < x.size(); ++i)
    if (std::abs(x.hi[i]) <= 2 * std::abs(correction[i])) x.hi[i] = x.lo[i] = 0;
}

/// (Hξ + c - Gᵀlambda)_x before rounding; an entry that cannot be told from 0 is 0.
Vector subgradient(const LinearQuadratic& f, const Set& set, const DoubleDoubleVector& xi,
                   const DoubleDoubleVector& lambda) {
  DoubleDoubleVector sum = slope(f, xi);
  Vector multipliers = Vector::Zero(f.rows());
  for (Index k = 0; k < set.size(); ++k) {
    const Index a = set.rows()[static_cast<std::size_t>(k)];
    set.problem().U.add_multiple(a, {-lambda.hi[k], -lambda.lo[k]}, sum);
    multipliers[a] = lambda.hi[k];
  }
  const Vector v = sum.value().head(f.n), terms = defect_terms(f, xi.hi, multipliers).head(f.n);
  return (v.array().abs() <= v_noise * terms.array()).select(0, v);
}

/// Hξ + c + W(x - z) - Gᵀlambda, rounded once.
Vector left_of_balance(const LinearQuadratic& f, const Metric& W, const Vector& z, const Set& set,
                       const DoubleDoubleVector& xi, const DoubleDoubleVector& lambda) {
  DoubleDoubleVector balance = gradient(f, W, z, xi);
  for (Index k = 0; k < set.size(); ++k)
    set.problem().U.add_multiple(set.rows()[static_cast<std::size_t>(k)], {-lambda.hi[k], -lambda.lo[k]},
                                 balance);
  return balance.value();
}

double largest_coefficient(const SparseRows& G, Index a) {
  double largest = 0;
  for (SparseRows::InnerIterator it(G, a); it; ++it) largest = std::max(largest, std::abs(it.value()));
  return largest;
}

/// How far x may move, in ||·||_W, where a row that is not held turns out to be violated by the rounding of
/// those held: to where it holds too, along them, with a multiplier that is no more than all of theirs.
double move_to_rows_outside(const LinearQuadratic& f, const Metric& W, Set& set, const DoubleDoubleVector& xi,
                            const Vector& lambda) {
  const NearestPointProblem& round = set.problem();
  double farthest = 0, pressing = 0;
  for (Index k = 0; k < set.size(); ++k) pressing += std::abs(lambda[k]) * set.factor().length(k);
  Set::Split split;
  for (Index a = 0; a < round.rows(); ++a) {
    if (set.holds(a)) continue;
    const double violation = -slack(round, a, xi).value();
    if (!(violation > 0)) continue;
    set.split(a, split);
    // A combination of those held, to rounding, may at least take the place of one of them.
    if (!(split.rho > 0)) {
      farthest = std::max(farthest, violation / split.length);
      continue;
    }
    const double multiplier = std::min(violation / (split.rho * split.rho), pressing / split.length);
    farthest = std::max(farthest, multiplier * W.norm(round.A.unwhiten(split.direction).head(f.n)));
  }
  return farthest;
}

}  // namespace

PolishedPoint polish(const LinearQuadratic& f, const Metric& W, const Vector& z,
                     const NearestPointProblem& round, const std::vector<Index>& rows, const Vector& start,
                     const Vector& multipliers, double scale) {
  Set set(round);
  set.append_block(rows, 0);
  const Index held = set.size();
  PolishedPoint found;
  if (held != static_cast<Index>(rows.size())) return found;

  DoubleDoubleVector xi(start), lambda(held);
  for (Index k = 0; k < held; ++k) lambda.hi[k] = multipliers[set.rows()[static_cast<std::size_t>(k)]];
  Vector dw, dlambda, r2(held);
  double last = std::numeric_limits<double>::infinity(), last_x = 0, gain = 1;
  Vector dxi, dmultipliers;
  for (int step = 0; step < most_corrections; ++step) {
    const Vector balance = left_of_balance(f, W, z, set, xi, lambda);
    for (Index k = 0; k < held; ++k)
      r2[k] = -slack(round, set.rows()[static_cast<std::size_t>(k)], xi).value();
    set.correct(round.A.whiten(-balance), r2, dw, dlambda);
    const Vector step_xi = round.A.unwhiten(dw);
    const double size = dw.norm(), x_size = f.n > 0 ? W.norm(step_xi.head(f.n)) : size;
    gain = size / last;
    if (step > 0 && !(gain <= slowest_gain)) {
      found.missing = f.n > 0 ? last_x : last;
      break;
    }
    dxi = step_xi;
    dmultipliers = dlambda;
    xi.add(dxi);
    lambda.add(dmultipliers);
    found.missing = step > 0 ? x_size * gain : x_size;
    last = size;
    last_x = x_size;
    found.converged = step > 0 && found.missing <= enough * scale;
    if (found.converged || size == 0) break;
  }
  found.converged = found.converged || last == 0 || found.missing <= will_do * scale;
  if (!found.converged) return found;
  // Where softness is far above the curvature of W, corrections creep, and end as if nothing were left.
  const Vector left = left_of_balance(f, W, z, set, xi, lambda);
  double open = f.auxiliaries() > 0 ? left.tail(f.auxiliaries()).cwiseAbs().maxCoeff() : 0;
  if (f.n > 0) found.missing += W.dual_norm(left.head(f.n));
  drop_noise(xi, dxi);
  drop_noise(lambda, dmultipliers);
  found.xi = xi.hi;
  found.v = subgradient(f, set, xi, lambda);
  found.missing += W.norm(xi.lo.head(f.n));
  if (f.n > 0) found.missing += outside_safety * move_to_rows_outside(f, W, set, xi, lambda.hi);
  found.lambda = Vector::Zero(f.rows());
  double largest = 0;
  for (Index k = 0; k < held; ++k) largest = std::max(largest, std::abs(lambda.hi[k]));
  std::vector<bool> free(static_cast<std::size_t>(f.rows()), false);
  for (Index a : f.two_sided) free[static_cast<std::size_t>(a)] = true;
  for (Index k = 0; k < held; ++k) {
    const Index a = set.rows()[static_cast<std::size_t>(k)];
    const bool falls = lambda.hi[k] < 0 && !free[static_cast<std::size_t>(a)];
    if (falls && lambda.hi[k] < -sign_noise * largest) found.converged = false;
    if (falls) open += -lambda.hi[k] * largest_coefficient(f.G, a);
    found.lambda[a] = falls ? 0 : lambda.hi[k];
  }
  // Auxiliary variables may hand that on to any entry of the covector.
  if (f.n > 0 && open > enough * defect_terms(f, found.xi, found.lambda).maxCoeff())
    found.missing += open * softness_of_entries(W).sum();
  return found;
}

}  // namespace convex::linear_quadratic
