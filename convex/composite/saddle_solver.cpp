#include "convex/composite/saddle_solver.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/multiplier_step.hpp"
#include "convex/composite/newton_polish.hpp"
#include "convex/composite/saddle_error.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/linear_algebra/pivoted_qr.hpp"

namespace convex::inline composite {
namespace {

constexpr Index outer_limit = 60;
/// What converges does so in some tens of evaluations of the inner function or the conditions, seldom
/// hundreds; after so many it will not.
constexpr Index evaluation_limit = 1000;
constexpr double growth = 8, largest_growth = 0x1p33;  ///< of D, by which outer steps converge superlinearly
constexpr double first_ridge = 1e-2, smallest_ridge = 1e-10;  ///< of the proximal term on w, times R
/// Below this part of the size of x there is only rounding; near it steps go on while they halve the
/// residual.
constexpr double rounding_level = 1e-15, near_rounding = 1e-13;
constexpr Index patience = 4;  ///< outer steps without progress before the end
/// The domains are apart when they stay this part of the sizes of x and u from each other along a normal of
/// which Mᵀ makes nothing, once little of it is taken off. A support point comes from projecting a point far
/// out: its truncation, one over the distance, and its rounding are both well below `separated`; a point
/// nearby shows the functions whose domain has no end but which overflow, the farthest one those with no end
/// along a small part of the normal.
constexpr double separated = 1e-5, separating = 1e-2, nearly_whole = 0.9, nearby = 4, far_out = 1e7,
                 farthest = 1e13, stiff = 0x1p120;
/// D is enlarged when multipliers exceed it by this factor.
constexpr double unbalanced = 16;
/// Exponents of 2 by which D is off where the steps do not come to an end, as none of its own data tells
/// them.
constexpr int other_scales[] = {-12, 12, -24, 24, -6, 6, -18, 18, -36, 36};
/// The error is not halved by so many of them, one after the other: the others will not do it.
constexpr int most_idle_scales = 4;

/// Do the terms' domains lie apart along the gap of a step? Its normal q = D·gap has Mᵀq = 0 then, and
/// q·b > sum of sup {q·u : u in a domain}, which the nearest point of a point far out along q
/// comes near to (a stiff prox is the projection on the domain).
bool separates(const SaddleProblem& problem, const MultiplierStep& step, const Vector& D) {
  Vector normal = D.cwiseProduct(step.gap).normalized();
  // Where the domains are round, the steps come to the normal slowly; what they miss of Mᵀq = 0 is taken off.
  const Matrix M = problem.M;
  normal -= M * linear_algebra::least_squares(M, normal);
  if (!(normal.norm() > nearly_whole)) return false;
  normal.normalize();
  const SparseMatrix magnitude = problem.M.cwiseAbs();
  const Vector image = problem.M * step.point.xi + problem.b;
  const double around = step.point.u.norm() + problem.b.norm() + problem.z.norm() +
                        (magnitude * step.point.xi.cwiseAbs()).norm();
  if (!(step.gap.norm() > separated * around)) return false;
  if (!((problem.M.transpose() * normal).norm() * step.point.xi.norm() <= separating * separated * around))
    return false;
  for (double out : {nearby, far_out, farthest}) {
    const Vector reach = prox_of_terms(problem, step.point.u + out * around * normal, stiff * D);
    const double reached = normal.cwiseAbs().dot(reach.cwiseAbs());
    if (!(normal.dot(image - reach) > separated * (around + reached))) return false;
  }
  return true;
}

/// ||x||_W + ||z||_W; when there is no x, the sizes of u and y.
double target_size(const SaddleProblem& problem, const SaddlePoint& point) {
  if (problem.n == 0) return solution_size(problem, point);
  return problem.W.norm(point.xi.head(problem.n)) + problem.W.norm(problem.z);
}

/// One run with a fixed D, from solution.point on.
void run(const SaddleProblem& problem, SaddleSolution& solution) {
  SaddlePoint& best = solution.point;
  const auto keep = [&](const SaddlePoint& point) {
    if (point.residual < best.residual || !std::isfinite(best.residual)) best = point;
  };
  const auto polish = [&](const SaddlePoint& from) {
    Polished polished = newton_polish(problem, from);
    solution.evaluations += polished.evaluations;
    return std::move(polished.point);
  };
  keep(polish(best));
  SaddlePoint centre = best;
  double factor = 1, ridge = first_ridge, last_gap = 0;
  Index idle = 0, apart = 0;
  for (Index outer = 0; outer < outer_limit && idle < patience && solution.evaluations < evaluation_limit &&
                        !WorkLimit::passed();
       ++outer) {
    const double before = best.residual;
    if (before <= rounding_level * target_size(problem, best)) break;
    const Vector D = factor * problem.D;
    const MultiplierStep step = multiplier_step(problem, centre, D, ridge * problem.R);
    solution.newton_steps += step.newton_steps;
    solution.evaluations += step.evaluations;
    ++solution.outer_steps;
    const double gap = step.gap.norm();
    apart = gap > 0.9 * last_gap ? apart + 1 : 0;
    last_gap = gap;
    if (apart >= 2 && !problem.all_pinned && separates(problem, step, D)) {
      solution.infeasible = true;
      return;
    }
    const SaddlePoint polished = polish(step.point);
    centre = step.point;
    keep(polished);
    if (polished.residual <= 0.5 * before) centre = polished;
    if (best.residual > 0.5 * before) {
      if (best.residual <= near_rounding * solution_size(problem, best)) break;
      if (factor >= largest_growth) ++idle;
    } else {
      idle = 0;
    }
    if (step.minimised) factor = std::min(growth * factor, largest_growth);
    ridge = std::max(ridge / growth, smallest_ridge);
  }
}

/// The size of the parts that a term's argument M ξ + b is made of, which may cancel.
double size_of_parts(const SaddleProblem& problem, const SaddlePoint& point, const SaddleTerm& term) {
  const double around = point.xi.norm() + problem.b.norm();
  const double factor = term.M.nonZeros() > 0 ? term.M.coeffs().abs().maxCoeff() : 0;
  return problem.b.segment(term.first, term.rows).norm() + factor * around;
}

/// How far, relative to its size, an argument is from where its term was evaluated.
double miss(const SaddleProblem& problem, const SaddlePoint& point) {
  double worst = 0;
  for (const SaddleTerm& term : problem.terms) {
    const double size = size_of_parts(problem, point, term);
    if (size > 0) worst = std::max(worst, point.r.segment(term.first, term.rows).norm() / size);
  }
  return worst;
}

/// The sum of what a value is made of, without signs.
double size_of_value(const SaddleProblem& problem, const SaddlePoint& point) {
  double size = point.xi.cwiseAbs().dot(problem.c.cwiseAbs());
  if (problem.Q.size() > 0) size += 0.5 * std::abs(point.xi.dot(problem.Q * point.xi));
  for (const SaddleTerm& term : problem.terms)
    size += term.scale * std::abs(term.f->value(point.u.segment(term.first, term.rows)));
  return size;
}

/// D changed to |y|/|u| in the terms where it is much smaller, and of a value where it is so much larger that
/// the rounding of D(t - u) is more than the value's: nothing else gave D its size there. False when there is
/// no such term.
bool balance(SaddleProblem& problem, const SaddlePoint& point) {
  bool changed = false;
  const double rounding = accuracy_of_prox / unit_roundoff * size_of_value(problem, point);
  for (const SaddleTerm& term : problem.terms) {
    const double u = size_of_parts(problem, point, term);
    auto d = problem.D.segment(term.first, term.rows);
    const double y = point.y.segment(term.first, term.rows).norm();
    const double factor = std::max(y / (u * d.maxCoeff()), unit_roundoff);  // y is known to this
    const bool too_large = problem.n == 0 && unbalanced * factor < 1 && d.maxCoeff() * u * u > rounding;
    if (!(factor > unbalanced || too_large) || !std::isfinite(factor)) continue;
    d *= std::exp2(std::floor(std::log2(factor)));
    changed = true;
  }
  if (changed && problem.n == 0) set_scales_of_w(problem);
  return changed;
}

double error_of(const SaddleProblem& problem, const SaddlePoint& point) {
  const SaddleError error = saddle_error(problem, point);
  return problem.n > 0 ? error.bound : error.of_value;
}

}  // namespace

bool domains_apart(const GraphForm& f) {
  constexpr double weak = 0x1p-40;      // of the metric that keeps ξ from running away
  constexpr double accurate = 0x1p-30;  // of the gaps
  constexpr int most_steps = 4;         // each from where the last one ended, in a weaker metric
  GraphForm domains{f.n, f.k, {}, 0};
  for (const GraphTerm& term : f.terms)
    if (!term.f->facts().finite) domains.terms.push_back({term.f, 1 / stiff, term.M, term.b});
  if (domains.terms.empty()) return false;
  double ridge = 1;
  SaddleProblem problem = saddle_problem(domains, Vector::Zero(f.n), Metric::identity(f.n));
  const Vector D = Vector::Ones(problem.m);
  SaddlePoint centre = saddle_point(problem, Vector::Zero(f.n + f.k), problem.b, D);
  for (int step = 0; step < most_steps; ++step) {
    ridge *= std::sqrt(std::sqrt(weak));
    problem.W = Metric::identity(f.n).scaled(ridge);
    problem.z = centre.xi.head(f.n);
    problem.G.topLeftCorner(f.n, f.n) = ridge * Matrix::Identity(f.n, f.n);
    set_sparse_part(problem);
    centre.y.setZero();
    const MultiplierStep near = multiplier_step(problem, centre, D, Vector::Constant(f.k, ridge), accurate);
    if (separates(problem, near, D)) return true;
    if (!(near.gap.norm() > separated * near.point.xi.norm())) return false;
    centre = near.point;
  }
  return false;
}

namespace {

SaddleSolution solve_balanced(SaddleProblem problem) {
  Vector xi = Vector::Zero(problem.n + problem.k);
  xi.head(problem.n) = problem.z;
  SaddleSolution solution;
  solution.point = saddle_point(problem, xi, problem.M * xi + problem.b, problem.D);
  run(problem, solution);
  // Without x nothing gave the first D its size, and a residual that is small beside u and y together may be
  // large beside one of them.
  const bool at_rounding =
      problem.n > 0 && solution.point.residual <= rounding_level * target_size(problem, solution.point);
  if (solution.infeasible || problem.all_pinned || at_rounding || !balance(problem, solution.point))
    return solution;
  SaddleSolution other = solution;
  other.evaluations = 0;
  const SaddlePoint& last = solution.point;
  other.point = saddle_point(problem, last.xi, last.u + last.y.cwiseQuotient(problem.D), problem.D);
  run(problem, other);
  const double missed = problem.n > 0 ? 0 : miss(problem, solution.point);
  const bool better = other.infeasible || (missed > near_rounding ? miss(problem, other.point) < missed
                                                                  : error_of(problem, other.point) <
                                                                        error_of(problem, solution.point));
  return better ? other : solution;
}

bool is_settled(const SaddleProblem& problem, const SaddleSolution& solution) {
  if (solution.infeasible) return true;
  const double size =
      problem.n > 0 ? target_size(problem, solution.point) : size_of_value(problem, solution.point);
  return error_of(problem, solution.point) <= accuracy_of_prox * size;
}

}  // namespace

SaddleSolution solve(const SaddleProblem& problem) {
  SaddleSolution best = solve_balanced(problem);
  if (!problem.look.at_other_scales) return best;
  int idle = 0;
  for (const int exponent : other_scales) {
    if (idle >= most_idle_scales || is_settled(problem, best) || WorkLimit::passed()) break;
    SaddleProblem other = problem;
    other.D *= std::exp2(exponent);
    other.R *= std::exp2(exponent);
    SaddleSolution next = solve_balanced(std::move(other));
    ++idle;
    if (next.infeasible) continue;
    // The error is estimated by the point's own multipliers, which see nothing of a row that is given up.
    const auto miss_of = [&](const SaddlePoint& at) {
      return largest_miss_of_rows(problem, at, at.xi.norm());
    };
    if (miss_of(next.point) > std::max(near_rounding, miss_of(best.point))) continue;
    const double error = error_of(problem, next.point), least = error_of(problem, best.point);
    if (error < 0.5 * least || (std::isfinite(error) && !std::isfinite(least))) idle = 0;
    if (error < least || !std::isfinite(least)) best = std::move(next);
  }
  return best;
}

}  // namespace convex::inline composite
