#include <algorithm>
#include <cmath>

#include "convex/laws/subject.hpp"
#include "convex/laws/worst_check.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"

namespace convex::inline law_checks {
namespace {

/// The largest ||x||_V / ||x||_W.
double largest_ratio(const Metric& V, const Metric& W) {
  return std::sqrt(linear_algebra::generalized_eigenvalues(gram_matrix(V), gram_matrix(W)).maxCoeff());
}

Check subgradient_law(const Subject& f, const Split& at, const Metric& W, const std::vector<Vector>& points) {
  WorstCheck worst("z - x is a subgradient of f at x = prox_f z");
  const double x_change = variation(f, at.x, at.bound);
  for (const Vector& u : points) {
    const double f_u = f.value(u);
    if (!std::isfinite(f_u)) continue;
    const double linear = at.v.dot(u - at.x), distance = W.norm(u - at.x);
    const double bound = value_roundings * (std::abs(f_u) + std::abs(at.f_x) +
                                            spectrum(W).largest * at.z.norm() * (u.norm() + at.x.norm())) +
                         f.membership * at.v.norm() * (u.norm() + at.x.norm()) +
                         at.bound * (distance + W.norm(at.z - at.x)) + x_change +
                         variation(f, u, unit_roundoff * u.norm());
    worst.take(std::max(0.0, at.f_x + linear - f_u), bound);
  }
  return worst.check();
}

void firm_law(const Split& a, const Split& b, const Metric& W, WorstCheck& worst) {
  const Vector dx = a.x - b.x, dz = a.z - b.z;
  const double value = W.inner(dx, dx) - W.inner(dx, dz);
  const double bound = (a.bound + b.bound) * (2 * W.norm(dx) + W.norm(dz));
  worst.take(std::max(0.0, value), bound);
}

void exchange_law(const Subject& f, const Split& at, const Metric& W, const Metric& V, WorstCheck& worst) {
  const Vector point = at.x + V.solve(at.v);
  const Split again = split(f, point, V);
  // A move e of x, ||e||_W <= bound, moves v by We.
  // Forming v = W(z - x) leaves u n |W| |z - x|, which V^-1 sees through its smallest eigenvalue.
  const double formed = 16 * unit_roundoff * static_cast<double>(point.size()) * spectrum(W).largest *
                        (at.z.norm() + at.x.norm()) / std::sqrt(spectrum(V).smallest);
  // Solving with V leaves u n condition(V) ||V^-1 v||_V (Higham 2002, Theorem 10.4).
  const double solved =
      4 * unit_roundoff * static_cast<double>(point.size()) * spectrum(V).condition() * V.dual_norm(at.v);
  const double bound =
      formed + solved + again.bound + at.bound * (2 * largest_ratio(V, W) + largest_ratio(W, V));
  worst.take(V.norm(again.x - at.x), bound);
}

}  // namespace

Split split(const Subject& f, const Vector& z, const Metric& W) {
  Prox prox = f.prox(z, W);
  Split found{z, std::move(prox.x), {}, 0, 0};
  found.v = W.multiply(z - found.x);
  found.f_x = f.value(found.x);
  found.bound = prox.error_bound + rounding_bound(W, z, found.x);
  return found;
}

double variation(const Subject& f, const Vector& x, double r) {
  double most = 0;
  const double f_x = f.value(x);
  if (!std::isfinite(f_x)) return 0;
  Vector moved = x;
  for (Index i = 0; i < x.size(); ++i) {
    for (double step : {r, -r}) {
      moved[i] = x[i] + step;
      const double value = f.value(moved);
      if (std::isfinite(value)) most = std::max(most, std::abs(value - f_x));
    }
    moved[i] = x[i];
  }
  return most * static_cast<double>(x.size());
}

std::vector<Check> prox_laws(const Subject& f, const Trial& trial, const std::vector<Vector>& others) {
  const Metric& W = trial.W;
  const Split at = split(f, trial.z, W);
  std::vector<Check> checks;
  checks.push_back(check_that("f is finite at x = prox_f z", std::isfinite(at.f_x) ? 0 : 1, 0));
  if (!std::isfinite(at.f_x)) return checks;

  std::vector<Split> neighbours;
  std::vector<Vector> points{trial.z};
  for (const Vector& other : others) {
    neighbours.push_back(split(f, other, W));
    points.push_back(neighbours.back().x);
    points.push_back((at.x + neighbours.back().x) / 2);
    for (double step : {1e-2, 1e-4, -1e-4, 1e-6, -1e-6})
      points.push_back(at.x + step * (neighbours.back().x - at.x));
    points.push_back(other);
  }
  checks.push_back(subgradient_law(f, at, W, points));
  WorstCheck firm("prox is firmly nonexpansive");
  for (const Split& neighbour : neighbours) firm_law(at, neighbour, W, firm);
  checks.push_back(firm.check());
  WorstCheck exchange("one subgradient serves every metric");
  for (const NamedMetric& V : trial_metrics(trial.z.size())) {
    exchange_law(f, at, W, V.W, exchange);
    exchange_law(f, at, W, V.W.scaled(0.125), exchange);
  }
  checks.push_back(exchange.check());
  return checks;
}

}  // namespace convex::inline law_checks
