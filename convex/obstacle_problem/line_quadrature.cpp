#include "convex/obstacle_problem/line_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace convex::inline obstacle_problem {

const GaussLegendre& gauss_legendre() {
  static const GaussLegendre rule = [] {
    GaussLegendre made{};
    constexpr std::size_t n = 8;
    for (std::size_t k = 0; k < n; ++k) {
      double x = std::cos(std::numbers::pi * (static_cast<double>(k) + 0.75) / (n + 0.5)), slope = 1;
      for (int newton = 0; newton < 8; ++newton) {  // from Tricomi's guess; four steps are enough
        double before = 1, here = x;
        for (std::size_t j = 2; j <= n; ++j) {
          const auto degree = static_cast<double>(j);
          const double next = ((2 * degree - 1) * x * here - (degree - 1) * before) / degree;
          before = here;
          here = next;
        }
        slope = n * (x * here - before) / (x * x - 1);
        x -= here / slope;
      }
      made.point[k] = x;
      made.weight[k] = 2 / ((1 - x * x) * slope * slope);
    }
    for (std::size_t k = 0; k < n; ++k) {  // Lagrange's polynomials
      made.at_low[k] = made.at_high[k] = 1;
      for (std::size_t j = 0; j < n; ++j) {
        if (j == k) continue;
        made.at_low[k] *= (-1 - made.point[j]) / (made.point[k] - made.point[j]);
        made.at_high[k] *= (1 - made.point[j]) / (made.point[k] - made.point[j]);
      }
    }
    return made;
  }();
  return rule;
}

double LineWeight::resistance(double a, double b) const {
  if (power == 0) return b - a;
  if (!(a > 0)) return b > a ? std::numeric_limits<double>::infinity() : 0;
  return power == 1 ? std::log1p((b - a) / a) : (b - a) / (a * b);
}

CellLoad cell_load(const std::function<double(double)>& h, LineWeight w, double a, double b) {
  CellLoad sum;
  if (a == b) return sum;
  sum.resistance = w.resistance(a, b);
  const GaussLegendre& rule = gauss_legendre();
  double before = 0;
  for (std::size_t k = 0; k < rule.point.size(); ++k) {
    const double r = a + (b - a) * (0.5 + 0.5 * rule.point[k]);
    const double source = w(r) * h(r), load = rule.weight[k] * source * (0.5 * (b - a)),
                 moment = load * w.resistance(r, b);
    sum.largest_source = std::max(sum.largest_source, source);
    if (k > 0) sum.variation += std::abs(source - before);
    before = source;
    sum.at_low += rule.at_low[k] * source;
    sum.at_high += rule.at_high[k] * source;
    sum.load += load;
    sum.moment += moment;
    sum.absolute += std::abs(load);
    sum.absolute_moment += std::abs(moment);
  }
  return sum;
}

}  // namespace convex::inline obstacle_problem
