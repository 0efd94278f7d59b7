#include "convex/piecewise/common_anchor.hpp"

#include <algorithm>

namespace convex::inline piecewise_quadratics {

double common_anchor(const Segment& a, const Segment& b, double from, double to) {
  const auto distance = [&](double x) { return std::max({from - x, x - to, 0.0}); };
  const double of_a = distance(a.x), of_b = distance(b.x);
  if (of_a != of_b) return of_a < of_b ? a.x : b.x;
  if ((a.rise == 0) != (b.rise == 0)) return a.rise == 0 ? b.x : a.x;
  return std::abs(a.x) <= std::abs(b.x) ? a.x : b.x;
}

}  // namespace convex::inline piecewise_quadratics
