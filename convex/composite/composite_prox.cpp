#include "convex/composite/composite_prox.hpp"

#include <cmath>

#include "convex/composite/attained_infimum.hpp"
#include "convex/composite/epigraph.hpp"
#include "convex/composite/saddle_error.hpp"
#include "convex/composite/saddle_solver.hpp"
#include "convex/counted.hpp"
#include "convex/infinity.hpp"

namespace convex::inline composite {
namespace {

void check_sizes(const GraphForm& f, Index n) {
  if (f.n != n)
    throw InvalidInput("graph form: a function of " + counted(f.n, "entry", "entries") + " at a point of " +
                       std::to_string(n) + "; give one of the same size");
}

/// sum_j scale_j (f_j(u_j) + f_j*(y_j / scale_j)) - y·u, which the conjugates' own formulas keep from 0.
double gap(const SaddleProblem& problem, const SaddlePoint& point, const Vector& covectors) {
  double sum = 0;
  for (const SaddleTerm& term : problem.terms) {
    const Vector u = point.u.segment(term.first, term.rows);
    const Vector y = covectors.segment(term.first, term.rows) / term.scale;
    const double part = term.f->value(u) + term.f->conjugate().node().value(y) - u.dot(y);
    // D(t - u) is known to roundings of Du, which may put a y on the edge of f*'s domain outside it.
    const double noise = unit_roundoff * point.D.segment(term.first, term.rows).cwiseProduct(u).norm();
    if (!std::isfinite(part) && noise > 0.1 * membership_tolerance * term.scale * y.norm()) continue;
    sum += term.scale * part;
  }
  return sum;
}

/// A sum of products and values, with what rounding may make of it.
struct Total {
  double value = 0, size = 0;
  void add(double part) {
    value += part;
    size += std::abs(part);
  }
  Value finished(double missed) const {
    constexpr double roundings = 16;
    return {value, roundings * unit_roundoff * size + missed};
  }
};

/// How far M ξ + b is from u beyond the rounding of the prox that gave u, as a part of the sizes that it is
/// made of.
double relative_miss(const SaddleProblem& problem, const SaddlePoint& point) {
  const SparseMatrix magnitude = problem.M.cwiseAbs();
  const Vector size = magnitude * point.xi.cwiseAbs() + problem.b.cwiseAbs();
  constexpr double roundings = 64;
  const double around = 1 + (magnitude * point.xi.cwiseAbs()).norm() + problem.z.norm();
  double worst = 0;
  for (const SaddleTerm& term : problem.terms) {
    // Where no multipliers exist t grows without end, and its rounding is no measure.
    const double t = std::min(point.t.segment(term.first, term.rows).norm(), around);
    const double rounding = roundings * unit_roundoff * t;
    const double r = point.r.segment(term.first, term.rows).norm() - rounding;
    if (r > 0) worst = std::max(worst, r / size.segment(term.first, term.rows).norm());
  }
  return worst;
}

/// The terms at u, and for all x' and w', with q for the quadratic terms together,
///   f(x') >= q(ξ) + (v, rho_w)·ξ' - smooth·ξ + sum_j y_j·b_j - scale_j f_j*(y_j / scale_j),
/// so that f*(v) is at most what does not depend on ξ', but for rho_w, which is rounding.
std::optional<PairOfValues> values_of(const GraphForm& f, const SaddleProblem& problem,
                                      const SaddlePoint& point, const Vector& covectors) {
  Total primal, dual;
  primal.add(f.constant);
  dual.add(-f.constant);
  for (const GraphTerm& term : f.terms)
    if (const auto form = term.f->quadratic_form(term.M.rows())) {
      const Vector shift = term.scale * term.b;
      const double at_zero =
          0.5 * shift.dot(form->Q * term.b) + form->c.dot(shift) + term.scale * form->constant;
      primal.add(at_zero);
      dual.add(-at_zero);
    }
  const Vector& xi = point.xi;
  for (Index i = 0; i < xi.size(); ++i) primal.add(problem.c[i] * xi[i]);
  if (problem.Q.size() > 0) {
    const double square = 0.5 * xi.dot(problem.Q * xi);
    primal.add(square);
    dual.add(square);
  }
  for (const SaddleTerm& term : problem.terms) {
    const Vector y = covectors.segment(term.first, term.rows);
    primal.add(term.scale * term.f->value(point.u.segment(term.first, term.rows)));
    dual.add(term.scale * term.f->conjugate().node().value(y / term.scale));
  }
  for (Index i = 0; i < problem.m; ++i) {
    primal.add(covectors[i] * point.r[i]);  // to first order, what the miss of M ξ + b costs
    dual.add(-covectors[i] * problem.b[i]);
  }
  if (!std::isfinite(primal.value) || !std::isfinite(dual.value)) return std::nullopt;
  Vector left = problem.c + problem.M.transpose() * covectors;
  if (problem.Q.size() > 0) left += problem.Q * xi;
  const double missed = left.tail(problem.k).cwiseAbs().dot(xi.tail(problem.k).cwiseAbs());
  return PairOfValues{primal.finished(covectors.cwiseAbs().dot(point.r.cwiseAbs())), dual.finished(missed),
                      relative_miss(problem, point)};
}

/// Are heights measured in a unit so far above the slopes at the solution, the largest that the normals of
/// epigraphs tell, that a miss in a height, which is rounding in such a unit, moves x? What v tells of slopes
/// has the normals of sets in it, too. Where a maximum has a small factor, so have the multipliers of its
/// heights, and the unit counts as little.
bool hides_heights(const SaddleProblem& problem, const SaddlePoint& point) {
  constexpr double far_above = 1024;
  double unit = 0, largest = 0;  // of the slopes, as a part of the unit
  for (const SaddleTerm& term : problem.terms) {
    const auto normal = point.y.segment(term.first, term.rows);
    const double height = std::abs(normal[term.rows - 1]);
    const auto parts = parts_of_epigraph(*term.f);
    if (!parts || !(height > 0)) continue;
    unit = std::max(unit, std::min(height, std::abs(parts->side)));
    largest = std::max(largest, normal.head(term.rows - 1).norm() / height);
  }
  return unit > far_above * std::max(1.0, largest * unit);
}

/// What the multipliers of heights miss of each other moves the slope of each part by as much of it: in a
/// unit far below the slopes that is no rounding where it would be one of a multiplier.
double moved_by_heights(const SaddleProblem& problem, const SaddlePoint& point) {
  const double missed = problem.k > 0 ? point.rho.tail(problem.k).cwiseAbs().maxCoeff() : 0;
  double most = 0;
  for (const SaddleTerm& term : problem.terms) {
    const auto normal = point.y.segment(term.first, term.rows);
    const double height = std::abs(normal[term.rows - 1]);
    if (!(height > missed) || !parts_of_epigraph(*term.f)) continue;
    const Vector slope =
        problem.M.middleRows(term.first, term.rows - 1).transpose() * normal.head(term.rows - 1);
    most = std::max(most, missed / height * problem.W.dual_norm(slope.head(problem.n)));
  }
  return most;
}

}  // namespace

Prox prox(const GraphForm& given, const Vector& z, const Metric& W, const Look& look) {
  check_sizes(given, z.size());
  check_sizes(given, W.dimension());
  const GraphForm f = with_attained_infimum(given);
  const SaddleProblem problem = saddle_problem(f, z, W, look);
  Prox found;
  found.route = ProxRoute::iterative;
  found.method = "semismooth Newton, method of multipliers";
  SaddleSolution solution;
  try {
    solution = solve(problem);
  } catch (const InvalidInput&) {  // numbers have left the range of doubles: no point is found
    found.status = Status::gave_up;
    found.error_bound = infinity;
    return found;
  }
  const SaddlePoint& point = solution.point;
  for (const GraphTerm& term : f.terms)
    found.by_conjugate = found.by_conjugate || term.f->prox_by_conjugate();
  found.x = point.xi.head(f.n);
  Vector smooth = problem.c;
  if (problem.Q.size() > 0) smooth += problem.Q * point.xi;
  const Vector own = own_covectors(problem, point);
  found.v = (smooth + problem.M.transpose() * own).head(f.n);
  if (solution.infeasible) {
    found.status = Status::infeasible;
    found.error_bound = infinity;
    return found;
  }
  SaddleError error = saddle_error(problem, point, ErrorOf::answer);
  if (f.by_slope) error.bound += moved_by_heights(problem, point);
  // Where the own formulas feel the rounding of u less than D(t - u) does, v is theirs.
  constexpr double worse = 2;
  const double of_own = W.dual_norm(metric_difference(W, found.x, z) + found.v);
  const bool theirs = of_own <= worse * error.bound;
  if (!theirs) found.v = (smooth + problem.M.transpose() * point.y).head(f.n);
  found.error_bound = theirs ? std::max(error.bound, of_own) : error.bound;
  found.duality_gap = gap(problem, point, theirs ? own : point.y);
  found.values = values_of(f, problem, point, theirs ? own : point.y);
  const double size = W.norm(z) + W.norm(found.x);
  // Where x and z are 0 beside the data, shifts b and slopes that cancel in v, only rounding of those is
  // asked for.
  const Vector root = problem.D.cwiseSqrt();
  const double data = size + root.cwiseProduct(problem.b).norm() + point.y.cwiseQuotient(root).norm();
  const bool solved = error.bound <= accuracy_of_prox * size ||
                      (error.bound <= accuracy_of_prox * data && error.bound <= 2 * error.rounding);
  const bool hidden = f.by_slope && hides_heights(problem, point);
  if (hidden) found.error_bound = infinity;
  found.status = solved && !hidden ? Status::solved : Status::inaccurate;
  return found;
}

}  // namespace convex::inline composite
