#include "convex/operations/tied_parts.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"

namespace convex::inline operations {

namespace {

/// A slope that the maximum may have, and the error of the value of its part.
struct Slope {
  Vector v;
  double error, relative_error;
};

/// Of the parts that may be the largest.
std::vector<Slope> possible_slopes(const Function& f, const Vector& x) {
  const auto* made = dynamic_cast<const Operation*>(&f.node());
  const std::vector<Function> parts = made ? made->maximum_of() : std::vector<Function>{};
  if (parts.size() < 2 || !x.allFinite()) return {};
  std::vector<Value> values;
  double least = -infinity;
  for (const Function& part : parts) {
    values.push_back(part.evaluate(x));
    least = std::max(least, values.back().value - values.back().error);
  }
  std::vector<Slope> slopes;
  if (!std::isfinite(least)) return slopes;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (values[k].value + values[k].error < least || !std::isfinite(values[k].value)) continue;
    if (const auto v = parts[k].subgradient(x); v && v->allFinite())
      slopes.push_back({*v, values[k].error, values[k].error / std::max(1.0, std::abs(values[k].value))});
  }
  return slopes;
}

}  // namespace

double doubt_of_ties(const Function& f, const Vector& x, const Metric& W) {
  const std::vector<Slope> slopes = possible_slopes(f, x);
  double doubt = 0;
  for (std::size_t k = 0; k < slopes.size(); ++k)
    for (std::size_t j = 0; j < k; ++j) {
      const double apart = W.dual_norm(slopes[k].v - slopes[j].v), error = slopes[k].error + slopes[j].error;
      if (error > 0 && apart > 0) doubt = std::max(doubt, std::min(error / apart, apart));
    }
  return doubt;
}

bool is_tied(const Function& f, const Vector& x) {
  constexpr double alike = 64 * unit_roundoff;
  constexpr double open_part = 1e-3;  // a value that is not known hides more than a tie
  const std::vector<Slope> slopes = possible_slopes(f, x);
  for (const Slope& slope : slopes)
    if (!(slope.relative_error <= open_part)) return false;
  for (const Slope& slope : slopes)
    if ((slope.v - slopes[0].v).norm() > alike * (slope.v.norm() + slopes[0].v.norm())) return true;
  return false;
}

}  // namespace convex::inline operations
