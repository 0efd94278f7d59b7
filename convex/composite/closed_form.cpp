#include "convex/composite/closed_form.hpp"

#include "convex/composite/metric_difference.hpp"

namespace convex::inline composite {
namespace {

/// What refinement in twice the working precision leaves of ||z||_W where 0 is meant.
constexpr double rounding_about_zero = 0x1p-96;

}  // namespace

Vector stationarity(const Vector& z, const Metric& W, const Vector& x, const Vector& v) {
  DoubleDoubleVector sum(v);
  add_metric_difference(W, x, z, sum);
  return sum.value();
}

Prox without_rounding_at_zero(Prox prox, const Facts& facts, const Vector& z, const Metric& W) {
  if (!(facts.cone || facts.support) || prox.x.size() != z.size()) return prox;
  const double size = W.norm(prox.x);
  if (size == 0 || !(size <= rounding_about_zero * W.norm(z))) return prox;
  prox.x.setZero();
  prox.error_bound += size;
  return prox;
}

Prox closed_form(const Vector& z, const Metric& W, Vector x, Vector v) {
  Prox result;
  result.error_bound = W.dual_norm(stationarity(z, W, x, v)) +
                       roundings_of_a_formula * unit_roundoff * (W.norm(z) + W.norm(x));
  result.x = std::move(x);
  result.v = std::move(v);
  result.method = "closed form";
  return result;
}

}  // namespace convex::inline composite
