#include <cmath>

#include "convex/composite/attained_infimum.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/composite/saddle_error.hpp"
#include "convex/composite/saddle_solver.hpp"
#include "convex/counted.hpp"
#include "convex/infinity.hpp"

namespace convex::inline composite {
namespace {

constexpr double tolerance = 1e-12;  ///< of a value, relative to the sizes of what it is a sum of
/// An error below this part of the squares of the sizes is nothing, even where the value is 0.
constexpr double vanishing_energy = 1e-20;
/// What the estimate of the error is told as: one step's length is what it is made of.
constexpr double told_as = 8;
/// A value of this part of them is what residuals at the end of twice the precision leave of 0.
constexpr double rounding_of_rounding = 0x1p-92;

/// scale f(Mx + b), with the membership tolerance relative to the sizes that Mx + b is made of.
double term_value(const GraphTerm& term, const Vector& x) {
  const Vector at = term.M * x + term.b;
  const double value = term.f->value(at);
  if (value < infinity) return term.scale * value;
  const double size = (term.M.cwiseAbs() * x.cwiseAbs() + term.b.cwiseAbs()).stableNorm();
  // A stiff prox is the projection on the domain, nearly.
  constexpr double stiff = 1e12;
  const Vector nearest = term.f->prox_diagonal(at, Vector::Constant(at.size(), stiff / (size * size)));
  return (at - nearest).stableNorm() <= membership_tolerance * size ? term.scale * term.f->value(nearest)
                                                                    : infinity;
}

/// What the bounds of the terms' domains say of the size of w.
double size_of_domains(const GraphForm& f) {
  double size = 0;
  for (const GraphTerm& term : f.terms)
    if (term.M.nonZeros() > 0)
      size = std::max(size, term.f->domain_size() / term.M.coeffs().abs().maxCoeff());
  return size;
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

/// The sum of the terms at (x, w).
double sum_of_terms(const GraphForm& f, const Vector& whole) {
  double sum = f.constant;
  for (const GraphTerm& term : f.terms) sum += term.scale * term.f->value(term.M * whole + term.b);
  return sum;
}

/// Does f(x, ·) fall without end from w along the direction of a gradient that no multiplier cancels?
bool falls_without_end(const GraphForm& f, const Vector& x, const Vector& w, const Vector& gradient) {
  if (!(gradient.norm() > 0)) return false;
  const Vector step = -(x.norm() + w.norm() + 1) / gradient.norm() * gradient;
  constexpr double far = 1e6, farther = 1e9, falling = 0.5;  // as the distance grows, nearly
  Vector whole(f.n + f.k);
  whole << x, w + far * step;
  const double there = sum_of_terms(f, whole);
  whole << x, w + farther * step;
  return there < 0 && sum_of_terms(f, whole) < falling * farther / far * there;
}

/// By weak duality the least value over w is at least, for any y in the domains of the conjugates,
///   constant - ½ w·Qw + Σ y_j·b_j - scale_j f_j*(y_j / scale_j) + rho·w',  rho = Qw + c + Mᵀy,
/// w' a minimiser: with |rho|·|w| in place of the last product, as if w' were no larger than w, which the
/// residual of the solver makes rounding. -inf where a y is outside a domain.
Value value_of_dual(const SaddleProblem& problem, const SaddlePoint& point, double constant) {
  double sum = constant, size = std::abs(constant);
  const auto add = [&](double part) {
    sum += part;
    size += std::abs(part);
  };
  if (problem.Q.size() > 0) add(-0.5 * point.xi.dot(problem.Q * point.xi));
  for (const SaddleTerm& term : problem.terms) {
    const Vector y = point.y.segment(term.first, term.rows);
    add(y.dot(problem.b.segment(term.first, term.rows)));
    add(-term.scale * term.f->conjugate().node().value(y / term.scale));
  }
  constexpr double roundings = 8;
  return {sum, point.rho.cwiseAbs().dot(point.xi.cwiseAbs()) + roundings * unit_roundoff * size};
}

}  // namespace

GraphValue evaluate(const GraphForm& given, const Vector& x) {
  if (given.n != x.size())
    throw InvalidInput("graph form: a function of " + counted(given.n, "entry", "entries") +
                       " at a point of " + std::to_string(x.size()) + "; give one of the same size");
  if (given.k == 0) return direct_value(given, x);
  const GraphForm f = with_attained_infimum(given);
  const SaddleProblem problem = saddle_problem(at_x(f, x), Vector(0), Metric::identity(0), Look{});
  const SaddleSolution solution = solve(problem);
  const SaddlePoint& point = solution.point;
  GraphValue found;
  found.value = f.constant;
  double size = std::abs(f.constant), outside = 0;
  const auto add = [&](double part) {
    found.value += part;
    size += std::abs(part);
  };
  Vector whole(f.n + f.k);
  whole << x, point.xi;
  const Vector covectors = own_covectors(problem, point);
  Vector slope = Vector::Zero(f.n + f.k);
  const double around_w = whole.norm() + size_of_domains(f);
  std::size_t j = 0;
  bool indicator = true;
  double constant = f.constant;  // of the quadratic part, w = 0
  for (const GraphTerm& term : f.terms) {
    if (const auto form = term.f->quadratic_form(term.M.rows())) {
      indicator = false;
      const Vector at = term.M * whole + term.b, image = form->Q * at;
      add(term.scale * (0.5 * at.dot(image) + form->c.dot(at) + form->constant));
      const Vector from = term.M.leftCols(f.n) * x + term.b;
      constant += term.scale * (0.5 * from.dot(form->Q * from) + form->c.dot(from) + form->constant);
      slope += term.scale * (term.M.transpose() * Vector(image + form->c));
      continue;
    }
    indicator = indicator && term.f->facts().indicator;
    const SaddleTerm& in = problem.terms[j++];
    const Vector r = point.r.segment(in.first, in.rows), y = point.y.segment(in.first, in.rows);
    add(term.scale * term.f->value(point.u.segment(in.first, in.rows)));
    // To first order what the miss r costs; with it the sum is a lower bound of the value.
    add(y.dot(r));
    slope += term.M.transpose() * covectors.segment(in.first, in.rows);
    // An argument near 0 carries the rounding of the w that it is the end of.
    const double argument = (term.M.cwiseAbs() * whole.cwiseAbs() + term.b.cwiseAbs()).norm();
    const double around =
        argument + (term.M.nonZeros() > 0 ? term.M.coeffs().abs().maxCoeff() * around_w : 0);
    if (around > 0) outside = std::max(outside, r.norm() / around);
  }
  outside = std::max(outside, largest_miss_of_rows(problem, point, around_w));
  if (solution.infeasible || outside > membership_tolerance) {
    found.value = infinity;
    // Only a functional that separates the domains proves it: a miss may be slow convergence.
    found.status = solution.infeasible ? Status::solved : Status::inaccurate;
    return found;
  }
  found.w = point.xi;
  if (indicator) {
    found.value = f.constant;
    found.v = Vector::Zero(f.n);
    if (largest_miss_beyond_rounding(problem, point, around_w) > membership_tolerance)
      found.error_bound = infinity;
    return found;
  }
  found.v = slope.head(f.n);
  const SaddleError error = saddle_error(problem, point);
  // Where a term bends sharply, as the root of u at 0, the first-order cost of the miss may be all of it.
  constexpr double of_misses = 4, of_estimate = 2;
  const double missed = of_misses * point.y.cwiseAbs().dot(point.r.cwiseAbs());
  found.error_bound = std::isfinite(error.bound)
                          ? of_estimate * error.of_value + missed + 8 * unit_roundoff * size
                          : infinity;
  // The estimate is held against the dual at the same point, where its multipliers are in the domains.
  // What rho leaves of it is rounding only where it is nothing beside the value; and multipliers outside of
  // the domains may be no more than the rounding of D(t - u).
  const double energy = point.u.dot(point.D.cwiseProduct(point.u));
  if (const Value dual = value_of_dual(problem, point, constant); std::isfinite(dual.value)) {
    const double apart = std::abs(found.value - dual.value);
    const double left = dual.error <= tolerance * size ? dual.error : 0;
    found.error_bound = std::max(found.error_bound, apart - left);
  } else {
    found.error_bound = std::max(found.error_bound, unit_roundoff * energy);
  }
  // What cannot be told from 0 is 0.
  const bool known = std::isfinite(found.error_bound);
  if (known && std::abs(found.value) <= std::max(found.error_bound, rounding_of_rounding * energy)) {
    found.error_bound += std::abs(found.value);
    found.value = 0;
  }
  const bool is_accurate = found.error_bound <= std::max(tolerance * size, vanishing_energy * energy);
  found.error_bound *= told_as;
  if (is_accurate) return found;
  found.status = Status::inaccurate;
  if (falls_without_end(f, x, point.xi, point.rho)) {
    found.value = -infinity;
    found.v.reset();
  }
  return found;
}

Value value_of(const GraphValue& found) {
  const bool open = found.status != Status::solved && !std::isfinite(found.value);
  return {found.value, open ? infinity : found.error_bound};
}

}  // namespace convex::inline composite
