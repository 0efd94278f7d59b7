#include "mechanics/motion/leaving_zero.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "convex/invariant.hpp"
#include "mechanics/motion/polynomial_root.hpp"

namespace mechanics::inline motions {
namespace {

/// The sum is looked at from where its first term comes so far on, each time so much later.
constexpr double ratio = 1.125;
constexpr int most_looks = 100;

}  // namespace

LeavingTerm leaving_term(std::span<const double> c, std::span<const double> by_rounding, std::size_t first,
                         double farthest, bool alone) {
  convex::invariant(c.size() <= most_coefficients, "series of a motion have fewer coefficients");
  std::array<double, most_coefficients> width;  // the time at which a term alone comes so far; else infinite
  width.fill(std::numeric_limits<double>::infinity());
  std::size_t nearest = first;
  for (std::size_t k = first; k < c.size(); ++k) {
    if (!(std::abs(c[k]) > by_rounding[k])) continue;
    const double root = 1 / static_cast<double>(k);  // their quotient may be no double
    width[k] = std::pow(farthest, root) / std::pow(std::abs(c[k]), root);
    if (width[k] < width[nearest]) nearest = k;
  }
  double sum = 0, at = width[nearest];
  for (int look = 0; !alone && look < most_looks && !(std::abs(sum) >= 1); ++look, at *= ratio) {
    sum = 0;
    for (std::size_t k = first; k < c.size(); ++k)
      if (std::isfinite(width[k])) sum += std::copysign(std::pow(at / width[k], k), c[k]);
  }
  std::size_t order = nearest;
  if (sum * c[nearest] < 0)
    for (std::size_t k = first; k < c.size(); ++k)
      if (c[k] * sum > 0 && (order == nearest || width[k] < width[order])) order = k;
  return {order, at};
}

}  // namespace mechanics::inline motions
