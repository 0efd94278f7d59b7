#include "convex/linear_quadratic/prox.hpp"

#include <cmath>

#include "convex/invalid_input.hpp"
#include "convex/linear_quadratic/minimise.hpp"
#include "convex/linear_quadratic/stationarity.hpp"

namespace convex {
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
  found.error_bound = point.error_bound;
  found.duality_gap = std::abs(complementarity(f, point.xi, point.lambda));
  found.method = f.auxiliaries() > 0 ? "active set on the epigraph" : "active set";
  return found;
}

}  // namespace convex
