#include "convex/linear_quadratic/prox.hpp"

#include <algorithm>
#include <cmath>

#include "convex/gamma0/facts.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_quadratic/minimise.hpp"
#include "convex/linear_quadratic/stationarity.hpp"

namespace convex::linear_quadratic {
namespace {

/// Whether Gξ >= h, with equality where it is asked for, but for a part of what the rows make of numbers as
/// large as ξ and z: auxiliary variables are right to that.
bool keeps_rows(const LinearQuadratic& f, const Vector& xi, const Vector& z) {
  const Vector slack = f.G * xi - f.h;
  const double size = std::max(xi.lpNorm<Eigen::Infinity>(), z.lpNorm<Eigen::Infinity>());
  const Vector terms = f.G.cwiseAbs() * Vector::Constant(xi.size(), size) + f.h.cwiseAbs();
  const auto is_kept = [&](Index a, double by) { return by >= -membership_tolerance * terms[a]; };
  for (Index a = 0; a < slack.size(); ++a)
    if (!is_kept(a, slack[a])) return false;
  return std::all_of(f.two_sided.begin(), f.two_sided.end(), [&](Index a) { return is_kept(a, -slack[a]); });
}

/// What the rounding of x to doubles is in a full metric, at most: |W_ij| <= sqrt(W_ii W_jj).
double rounding_in(const Metric& W, const Vector& x) {
  if (W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal) return 0;
  return unit_roundoff * x.cwiseAbs().dot(W.diagonal().cwiseSqrt());
}

}  // namespace

Prox prox(const LinearQuadratic& f, const Vector& z, const Metric& W) {
  validate(f, "prox");
  if (z.size() != f.n || W.dimension() != f.n)
    throw InvalidInput(
        "prox: the point, the metric and the function differ in size; give them one dimension");
  if (!z.allFinite()) throw InvalidInput("prox: the point is not finite; give numbers");
  const ProgramPoint point = minimise(f, W, z);
  Prox found;
  found.route = ProxRoute::active_set;
  found.status = point.status;
  if (point.status == Status::infeasible || point.v.size() != f.n) {
    found.method = point.defect == Defect::unbounded_below ? "active set: the function is -inf"
                                                           : "active set: the domain is empty";
    if (point.status != Status::infeasible) found.method = "active set: gave up";
    return found;
  }
  found.x = point.xi.head(f.n);
  found.v = point.v;
  found.error_bound = point.error_bound + rounding_in(W, found.x);
  if (!keeps_rows(f, point.xi, z)) {  // in a metric that is nearly singular: then x is anywhere
    found.error_bound = infinity;
    found.status = Status::inaccurate;
  }
  found.duality_gap = std::abs(complementarity(f, point.xi, point.lambda));
  found.method = f.auxiliaries() > 0 ? "active set on the epigraph" : "active set";
  return found;
}

}  // namespace convex::linear_quadratic
