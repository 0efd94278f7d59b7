#include "mechanics/liquid/proved_zero.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/interval_arithmetic.hpp"

namespace mechanics::liquid {
namespace {

using expression::Range;

/// h <= 0 on a box, halved so many times along its longest side.
bool has_no_source(const Field& h, const Region& box, std::size_t dimension, int halvings) {
  const Range values = h.range(box);
  if (!values.is_empty() && values.high <= 0) return true;
  if (halvings == 0) return false;
  const auto longest =
      std::max_element(box.begin(), box.begin() + static_cast<std::ptrdiff_t>(dimension),
                       [](const Range& a, const Range& b) { return a.high - a.low < b.high - b.low; });
  const std::size_t axis = static_cast<std::size_t>(longest - box.begin());
  const double half = 0.5 * (longest->low + longest->high);
  Region low = box, high = box;
  low[axis].high = high[axis].low = half;
  return has_no_source(h, low, dimension, halvings - 1) && has_no_source(h, high, dimension, halvings - 1);
}

/// At least the square of |F|.
double force_squared(const LiquidScene& scene, const Region& box) {
  double sum = 0;
  for (const Field& force : scene.force) {
    const Range values = force.range(box);
    if (values.is_empty()) return std::numeric_limits<double>::infinity();
    const double largest = std::max(std::abs(values.low), std::abs(values.high));
    sum = convex::moved_up(sum + convex::moved_up(largest * largest));
  }
  return sum;
}

}  // namespace

bool is_proved_zero(const LiquidScene& scene) {
  constexpr int halvings = 12;
  constexpr double ends = 0x1p-50;  // of the domain's size: what its ends may be off
  Region box{};
  for (std::size_t i = 0; i < scene.dimension(); ++i) {
    const double size = std::max({std::abs(scene.domain.low[i]), std::abs(scene.domain.high[i])});
    box[i] = {scene.domain.low[i] - ends * size, scene.domain.high[i] + ends * size};
  }
  const double driven = force_squared(scene, box);
  for (const BoundaryPart& part : scene.parts) {
    const Range values = part.value.range(box);
    if (values.is_empty()) return false;
    if (part.is_free ? values.low != 0 || values.high != 0
                     : !(values.low >= 0 && convex::moved_down(values.low * values.low) >= driven))
      return false;
  }
  return has_no_source(scene.h, box, scene.dimension(), halvings);
}

}  // namespace mechanics::liquid
