#include "convex/operations/tied_parts.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"

namespace convex::inline operations {

double doubt_of_ties(const Function& f, const Vector& x, const Metric& W) {
  const auto* made = dynamic_cast<const Operation*>(&f.node());
  const std::vector<Function> parts = made ? made->maximum_of() : std::vector<Function>{};
  if (parts.size() < 2 || !x.allFinite()) return 0;
  std::vector<Value> values;
  double least = -infinity;
  for (const Function& part : parts) {
    values.push_back(part.evaluate(x));
    least = std::max(least, values.back().value - values.back().error);
  }
  if (!std::isfinite(least)) return 0;
  struct Slope {
    Vector v;
    double error;
  };
  std::vector<Slope> slopes;
  double doubt = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (values[k].value + values[k].error < least || !std::isfinite(values[k].value)) continue;
    const std::optional<Vector> v = parts[k].subgradient(x);
    if (!v || !v->allFinite()) continue;
    for (const Slope& other : slopes) {
      const double apart = W.dual_norm(*v - other.v), error = values[k].error + other.error;
      if (error > 0 && apart > 0) doubt = std::max(doubt, std::min(error / apart, apart));
    }
    slopes.push_back({*v, values[k].error});
  }
  return doubt;
}

}  // namespace convex::inline operations
