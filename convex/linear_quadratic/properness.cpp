#include "convex/linear_quadratic/properness.hpp"

#include <string>

#include "convex/invalid_input.hpp"

namespace convex::linear_quadratic {

Defect properness(const LinearQuadratic& f) {
  validate(f, "properness");
  // The point of least norm that satisfies all rows.
  LinearQuadratic domain = f;
  domain.n = f.variables();
  domain.H.setZero();
  domain.c.setZero();
  const ProgramPoint point = minimise(domain, Metric::identity(f.variables()), Vector::Zero(f.variables()));
  if (point.defect == Defect::empty_domain) return Defect::empty_domain;
  return descent_ray(f).size() > 0 ? Defect::unbounded_below : Defect::none;
}

void require_proper(const LinearQuadratic& f, const char* where) {
  const Defect defect = properness(f);
  if (defect == Defect::empty_domain)
    throw InvalidInput(std::string(where) + ": +inf everywhere; give conditions that some point satisfies");
  if (defect == Defect::unbounded_below)
    throw InvalidInput(std::string(where) + ": -inf wherever it is finite; bound it from below");
}

}  // namespace convex::linear_quadratic
