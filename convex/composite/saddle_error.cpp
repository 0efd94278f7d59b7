#include "convex/composite/saddle_error.hpp"

#include <cmath>

#include "convex/composite/newton_polish.hpp"
#include "convex/composite/newton_system.hpp"
#include "convex/composite/sensitivity_system.hpp"

namespace convex::inline composite {
namespace {

/// A prox may be wrong by this many roundings of its result and of its step t - u.
constexpr double prox_roundings = 2;
/// So many per row and column where it decomposes a matrix, as a whole: singular vectors come out orthogonal
/// to some 4 roundings per row and column.
constexpr double decomposition_roundings = 6;
/// A residual above this part of the sizes is not rounding, and the Newton step from there is not exact.
constexpr double settled = 1e-13;
/// What the estimated errors of y and w are multiplied by to be safe, at rounding level and far from it; and
/// that of x, at rounding level, where it may be much smaller than monotonicity shows: where the terms' own
/// curvature, and not W, holds x.
constexpr double safety = 2, far_safety = 20, own_safety = 4;
/// What the sensitivities of an answer are regularised with, as parts of D and R: only the rounding of a
/// Jacobian is below.
constexpr double answer_theta = 1e-13, answer_ridge = 1e-14;

/// Bounds on the absolute values of what rounding does to a point's parts.
struct Rounding {
  Vector u;    // m: the error of the prox
  Vector r;    // m: and that of the sum
  Vector x;    // n: the error of the prox, where x comes from it
  Vector rho;  // n + k: what the prox's error makes of y, and the last rounding
};

Rounding rounding_of(const SaddleProblem& problem, const SaddlePoint& point) {
  const SparseMatrix magnitude = problem.M.cwiseAbs();
  Rounding rounding;
  rounding.u = prox_roundings * unit_roundoff * (point.u.cwiseAbs() + (point.t - point.u).cwiseAbs());
  for (const SaddleTerm& term : problem.terms)
    if (const Index size = term.f->decomposed_size(term.rows); size > 0) {
      const Vector u = point.u.segment(term.first, term.rows), t = point.t.segment(term.first, term.rows);
      const double whole =
          decomposition_roundings * static_cast<double>(size) * unit_roundoff * (u.norm() + (t - u).norm());
      const double spread = whole / std::sqrt(static_cast<double>(term.rows));
      rounding.u.segment(term.first, term.rows) = rounding.u.segment(term.first, term.rows).cwiseMax(spread);
    }
  rounding.r = rounding.u + unit_roundoff * point.r.cwiseAbs();
  // Heights that are far above their differences, as beside a large constant, are rounded as they are.
  rounding.r += unit_roundoff * (magnitude.rightCols(problem.k) * point.xi.tail(problem.k).cwiseAbs());
  rounding.rho =
      magnitude.transpose() * point.D.cwiseProduct(rounding.u) + unit_roundoff * point.rho.cwiseAbs();
  rounding.x = Vector::Zero(problem.n);
  for (Index i = 0; i < problem.n; ++i)
    if (const Index row = problem.pin[static_cast<std::size_t>(i)]; row >= 0)
      rounding.x[i] = rounding.u[row] + unit_roundoff * (problem.b[row] != 0 ? std::abs(point.xi[i]) : 0);
  return rounding;
}

/// The residual that rounding may leave of a point, as `SaddlePoint::residual` measures it.
double residual_of(const SaddleProblem& problem, const Rounding& rounding) {
  const double x_part = problem.W.dual_norm(rounding.rho.head(problem.n));
  const double w_part = rounding.rho.tail(problem.k).cwiseQuotient(problem.R.cwiseSqrt()).norm();
  const double r_part = problem.D.cwiseSqrt().cwiseProduct(rounding.r).norm();
  return std::hypot(x_part, w_part, r_part);
}

/// Does Newton's step from a point come to rounding? Only then is its length the distance to the solution: on
/// the pieces of a point from which no step was taken yet, or after which the steps were cut short, it may be
/// 0 however far that is.
bool leads_to_rounding(const SaddleProblem& problem, const SaddlePoint& point, const Rounding& rounding) {
  constexpr double roundings = 64;
  const NewtonSystem system(problem, point.t, point.D, polish_theta, polish_ridge * problem.R);
  if (!system.usable()) return false;
  const NewtonStep step = system.step(point.rho, point.r);
  const SaddlePoint next = saddle_point(problem, point.xi + step.dxi, point.t + step.dt, point.D);
  return next.residual <=
         std::max(settled * solution_size(problem, next), roundings * residual_of(problem, rounding));
}

/// What the pieces that the point is on cannot mend of a residual is rounding, of its terms or of x and z, or
/// a small part of it; else the point is on the wrong pieces, and a step within them says nothing of its
/// distance. All are in the units of `scale`, the roots of D or 1/R; `size` is that of x and z.
bool is_rounding(const Vector& left, const Vector& residual, const Vector& rounding, const Vector& scale,
                 double size) {
  constexpr double roundings = 64, part = 0.1;
  const Vector weighed = scale.cwiseProduct(left);
  if (weighed.norm() <= settled * size) return true;
  for (Index i = 0; i < left.size(); ++i)
    if (std::abs(left[i]) > std::max(roundings * rounding[i], part * std::abs(residual[i]))) return false;
  return true;
}

/// How far the solution may be from a point: the largest of the Newton step from there and of those that
/// rounding could cause, with signs that a pattern does not cancel.
struct Moves {
  double dx = 0;       // in ||·||_W
  Vector dy, dw;       // m, k
  bool known = false;  // no part of a residual is left that no y and w can mend
};

template <class System>
Moves moves_of(const SaddleProblem& problem, const SaddlePoint& point, const Rounding& rounding, double theta,
               const Vector& ridge) {
  const System system(problem, point.t, point.D, theta, ridge);
  Moves moves{0, Vector::Zero(problem.m), Vector::Zero(problem.k), system.usable()};
  if (!system.usable()) return moves;
  const double size = problem.n > 0 ? problem.W.norm(point.xi.head(problem.n)) + problem.W.norm(problem.z)
                                    : solution_size(problem, point);
  const Vector root_of_D = problem.D.cwiseSqrt(), root_of_R = problem.R.cwiseSqrt().cwiseInverse();
  for (int probe = 0; probe < 4; ++probe) {
    const auto sign = [&](Index i) {
      return std::fmod(0.7548776662466927 * static_cast<double>((probe + 1) * (i + 1)), 1.0) < 0.5 ? -1.0
                                                                                                   : 1.0;
    };
    Vector rho = point.rho, r = point.r;
    for (Index i = 0; i < rho.size(); ++i) rho[i] += sign(i) * rounding.rho[i];
    for (Index i = 0; i < r.size(); ++i) r[i] += sign(i + 7) * rounding.r[i];
    NewtonStep step = system.step(rho, r);
    // What the step leaves of r and rho no y and w can mend (dependent rows); it says nothing about y - y*.
    const Vector r_left = theta * step.dy.cwiseQuotient(point.D);
    const Vector w_left = ridge.cwiseProduct(step.dxi.tail(problem.k));
    moves.known =
        moves.known && is_rounding(r_left, point.r, rounding.r, root_of_D, size) &&
        is_rounding(w_left, point.rho.tail(problem.k), rounding.rho.tail(problem.k), root_of_R, size);
    r -= r_left;
    rho.tail(problem.k) += w_left;
    step = system.step(rho, r);
    moves.dx = std::max(moves.dx, problem.W.norm(step.dxi.head(problem.n)));
    moves.dw = moves.dw.cwiseMax(step.dxi.tail(problem.k).cwiseAbs());
    moves.dy = moves.dy.cwiseMax(step.dy.cwiseAbs());
  }
  return moves;
}

}  // namespace

SaddleError saddle_error(const SaddleProblem& problem, const SaddlePoint& point, ErrorOf of) {
  if (!point.t.allFinite()) return {INFINITY, INFINITY, INFINITY};
  const Rounding rounding = rounding_of(problem, point);
  bool scattered = false;
  for (const SaddleTerm& term : problem.terms) scattered = scattered || !term.separable;
  SaddleError error;
  const double x_part = problem.scales.norm_of_size(rounding.x, scattered);
  const double y_part = problem.scales.dual_norm_of_size(rounding.rho.head(problem.n), scattered);
  error.rounding = x_part + y_part;
  const double stationarity = problem.W.dual_norm(point.rho.head(problem.n));
  // With e = x - x*, the exact prox x - e_x and its subgradient y + e_y: by monotonicity
  // (rho + e_y - We)·(e - e_x) >= 0, so ||e||² <= ||e|| (||rho|| + ||e_y|| + ||e_x||) + ||rho|| ||e_x||.
  const double linear = stationarity + error.rounding, constant = stationarity * x_part;
  if (problem.all_pinned) {
    error.bound = 0.5 * (linear + std::sqrt(linear * linear + 4 * constant));
    error.proven = true;
    return error;
  }
  const bool at_rounding = point.residual <= settled * solution_size(problem, point);
  Moves moves = moves_of<NewtonSystem>(problem, point, rounding, polish_theta, polish_ridge * problem.R);
  if (of == ErrorOf::answer && at_rounding) {
    const Moves sharp =
        moves_of<SensitivitySystem>(problem, point, rounding, answer_theta, answer_ridge * problem.R);
    if (sharp.known) {
      moves.dx = std::max(moves.dx, sharp.dx);
      moves.dy = moves.dy.cwiseMax(sharp.dy);
      moves.dw = moves.dw.cwiseMax(sharp.dw);
    }
  }
  if (!at_rounding) moves.known = moves.known && leads_to_rounding(problem, point, rounding);
  const auto& [dx, dy, dw, known] = moves;
  const double factor = at_rounding ? safety : far_safety;
  const double product = factor * (dy.dot(point.r.cwiseAbs() + rounding.r) +
                                   dw.dot((point.rho.cwiseAbs() + rounding.rho).tail(problem.k)));
  error.of_value = product;
  const double monotone = 0.5 * (linear + std::sqrt(linear * linear + 4 * (constant + product)));
  error.bound = at_rounding ? std::min(std::max(monotone, factor * dx), own_safety * dx)
                            : std::max(monotone, factor * dx);
  error.rounding = std::min(error.bound, error.rounding + factor * dx);
  if (!known || !std::isfinite(error.bound)) error.bound = INFINITY;
  return error;
}

}  // namespace convex::inline composite
