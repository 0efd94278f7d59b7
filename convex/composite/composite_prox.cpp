#include "convex/composite/composite_prox.hpp"

#include <cmath>
#include <limits>

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/saddle_error.hpp"
#include "convex/composite/saddle_solver.hpp"

namespace convex {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tolerance = 1e-12;  ///< of x, relative to ||z||_W + ||x||_W

void check_sizes(const GraphForm& f, Index n) {
  if (f.n != n)
    throw InvalidInput("graph form: a function of " + std::to_string(f.n) + " entries at a point of " +
                       std::to_string(n) + "; give one of the same size");
}

/// sum_j scale_j (f_j(u_j) + f_j*(y_j / scale_j)) - y·u, which the conjugates' own formulas keep from 0.
double gap(const SaddleProblem& problem, const SaddlePoint& point) {
  double sum = 0;
  for (const SaddleTerm& term : problem.terms) {
    const Vector u = point.u.segment(term.first, term.rows);
    const Vector y = point.y.segment(term.first, term.rows) / term.scale;
    sum += term.scale * (term.f->value(u) + term.f->conjugate().node().value(y) - u.dot(y));
  }
  return sum;
}

/// scale f(Mx + b), with the membership tolerance relative to the sizes that Mx + b is made of.
double term_value(const GraphTerm& term, const Vector& x) {
  const Vector at = term.M * x + term.b;
  const double value = term.f->value(at);
  if (value < infinity) return term.scale * value;
  const double size = (term.M.cwiseAbs() * x.cwiseAbs() + term.b.cwiseAbs()).norm();
  // A stiff prox is the projection on the domain, nearly.
  constexpr double stiff = 1e12;
  const Vector nearest = term.f->prox_diagonal(at, Vector::Constant(at.size(), stiff / (size * size)));
  return (at - nearest).norm() <= membership_tolerance * size ? term.scale * term.f->value(nearest)
                                                              : infinity;
}

/// The terms as functions of w at a given x.
GraphForm at_x(const GraphForm& f, const Vector& x) {
  GraphForm rest{0, f.k, {}, f.constant};
  for (const GraphTerm& term : f.terms)
    rest.terms.push_back({term.f, term.scale, term.M.rightCols(f.k), term.b + term.M.leftCols(f.n) * x});
  return rest;
}

GraphValue direct_value(const GraphForm& f, const Vector& x) {
  GraphValue found{f.constant, Vector(0), Vector::Zero(f.n), 0, Status::solved};
  double size = std::abs(f.constant);
  for (const GraphTerm& term : f.terms) {
    const double part = term_value(term, x);
    found.value += part;
    size += std::abs(part);
    const std::optional<Vector> slope = term.f->subgradient(term.M * x + term.b);
    if (slope && found.v)
      *found.v += term.scale * (term.M.transpose() * *slope);
    else
      found.v.reset();
  }
  found.error_bound = 4 * unit_roundoff * size;
  return found;
}

}  // namespace

Prox prox(const GraphForm& f, const Vector& z, const Metric& W) {
  check_sizes(f, z.size());
  check_sizes(f, W.dimension());
  const SaddleProblem problem = saddle_problem(f, z, W);
  const SaddleSolution solution = solve(problem);
  const SaddlePoint& point = solution.point;
  Prox found;
  found.route = ProxRoute::iterative;
  found.method = "semismooth Newton, method of multipliers";
  found.x = point.xi.head(f.n);
  Vector v = problem.M.transpose() * point.y + problem.c;
  if (problem.Q.size() > 0) v += problem.Q * point.xi;
  found.v = v.head(f.n);
  if (solution.infeasible) {
    found.status = Status::infeasible;
    found.error_bound = infinity;
    return found;
  }
  const SaddleError error = saddle_error(problem, point);
  found.error_bound = error.bound;
  found.duality_gap = gap(problem, point);
  const double size = W.norm(z) + W.norm(found.x);
  // Where x and z are 0 beside the data, only rounding of the data is asked for.
  const double data = size + problem.D.cwiseSqrt().cwiseProduct(problem.b).norm();
  const bool solved = error.bound <= tolerance * size ||
                      (error.bound <= tolerance * data && error.bound <= 2 * error.rounding);
  found.status = solved ? Status::solved : Status::inaccurate;
  return found;
}

GraphValue evaluate(const GraphForm& f, const Vector& x) {
  check_sizes(f, x.size());
  if (f.k == 0) return direct_value(f, x);
  const GraphForm rest = at_x(f, x);
  const SaddleProblem problem = saddle_problem(rest, Vector(0), Metric::identity(0));
  const SaddleSolution solution = solve(problem);
  const SaddlePoint& point = solution.point;
  GraphValue found;
  found.value = f.constant;
  double size = std::abs(f.constant);
  const auto add = [&](double part) {
    found.value += part;
    size += std::abs(part);
  };
  Vector whole(f.n + f.k);
  whole << x, point.xi;
  Vector slope = Vector::Zero(f.n + f.k);
  bool outside = solution.infeasible;
  std::size_t j = 0;
  for (const GraphTerm& term : f.terms) {
    if (slope_of(*term.f) || is_half_square(*term.f)) {
      const Vector at = term.M * whole + term.b;
      add(term.scale * term.f->value(at));
      slope += term.scale * (term.M.transpose() * *term.f->subgradient(at));
      continue;
    }
    const SaddleTerm& in = problem.terms[j++];
    const Vector r = point.r.segment(in.first, in.rows), y = point.y.segment(in.first, in.rows);
    add(term.scale * term.f->value(point.u.segment(in.first, in.rows)));
    // To first order what the miss r costs; with it the sum is a lower bound of the value.
    add(y.dot(r));
    slope += term.M.transpose() * y;
    const double around = (term.M.cwiseAbs() * whole.cwiseAbs() + term.b.cwiseAbs()).norm();
    outside = outside || r.norm() > membership_tolerance * around;
  }
  if (outside) {
    found.value = infinity;
    found.status = solution.infeasible ? Status::solved : Status::inaccurate;
    return found;
  }
  found.w = point.xi;
  found.v = slope.head(f.n);
  found.error_bound = saddle_error(problem, point).of_value + 8 * unit_roundoff * size;
  if (!(found.error_bound <= tolerance * size)) found.status = Status::inaccurate;
  return found;
}

}  // namespace convex
