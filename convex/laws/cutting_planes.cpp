#include "convex/laws/cutting_planes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/prox.hpp"

namespace convex::inline law_checks {
namespace {

/// Roundings of a value and of a tangent's, relative to the terms in them.
constexpr double roundings = 64 * unit_roundoff;

/// Kinks are found in as many tangents as there are pieces; each curved direction takes some ten.
constexpr Index most_tangents = 80;

}  // namespace

std::optional<Prox> prox_by_cutting_planes(
    const std::function<double(const Vector&)>& value,
    const std::function<std::optional<Vector>(const Vector&)>& subgradient, const Vector& z,
    const Metric& W) {
  Prox best;
  best.route = ProxRoute::iterative;
  best.method = "cutting planes";
  best.error_bound = std::numeric_limits<double>::infinity();
  Matrix A(0, z.size());
  Vector b(0), x = z;
  for (Index k = 0; k < most_tangents; ++k) {
    const double at_x = value(x);
    const std::optional<Vector> v = subgradient(x);
    if (!v || !std::isfinite(at_x)) return std::nullopt;
    if (k > 0) {
      const double of_model = (A * x + b).maxCoeff();
      const double noise =
          roundings * (std::abs(at_x) + (A.cwiseAbs() * x.cwiseAbs() + b.cwiseAbs()).maxCoeff());
      const double bound = std::sqrt(2 * (std::max(0.0, at_x - of_model) + noise));
      if (bound < best.error_bound) {
        best.x = x;
        best.error_bound = bound;
      }
      if (!(at_x - of_model > noise)) break;
    }
    A.conservativeResize(k + 1, Eigen::NoChange);
    b.conservativeResize(k + 1);
    A.row(k) = v->transpose();
    b[k] = at_x - v->dot(x);
    const Prox next = prox(linear_quadratic::max_affine(A, b), z, W);
    if (next.x.size() != z.size()) break;
    x = next.x;
  }
  if (best.x.size() != z.size()) return std::nullopt;
  best.v = W.multiply(z - best.x);
  return best;
}

}  // namespace convex::inline law_checks
