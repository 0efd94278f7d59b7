#include "mechanics/motion/step_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/vector.hpp"

namespace mechanics::inline motions {

double tolerance_of_step(double tolerance) {
  return std::max(part_of_a_step * tolerance, 0.5 * convex::unit_roundoff);
}

int taylor_order(double tolerance) {
  constexpr int least = 8, most = 40;
  constexpr double orders_of_digit = 0.8;
  return std::clamp(static_cast<int>(std::ceil(-orders_of_digit * std::log(tolerance) + 1)) + 2, least, most);
}

namespace {

/// The largest of the first terms is what the last ones are compared with.
constexpr std::size_t compared_terms = 3;

/// By the logarithms of the sizes of coefficients 0, 1, …; those before `first` do not count. |c_k| h^k =
/// tolerance |c_j| h^j at log h = (log tolerance + log |c_j| - log |c_k|) / (k - j).
template <class Size>
double length(std::size_t count, Size size, std::size_t first, double tolerance) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (count == 0) return infinite;
  const std::size_t last = count - 1;
  std::size_t top = last;
  while (top > 0 && size(top) == 0) --top;
  if (2 * top <= last) return infinite;
  double early[compared_terms];
  for (std::size_t j = 0; j < compared_terms; ++j)
    early[j] = first + j < count ? std::log(tolerance * size(first + j)) : -infinite;
  if (*std::max_element(early, early + compared_terms) == -infinite) return infinite;  // nothing to compare
  double shortest = infinite;
  for (const std::size_t k : {top, top - 1}) {
    if (size(k) == 0) continue;
    const double late = std::log(size(k));
    double longest = -infinite;
    for (std::size_t j = first; j < std::min(k, first + compared_terms); ++j)
      longest = std::max(longest, (early[j - first] - late) / static_cast<double>(k - j));
    shortest = std::min(shortest, longest);
  }
  return std::exp(shortest);
}

}  // namespace

double step_length(std::span<const double> sizes, double tolerance) {
  return length(
      sizes.size(), [&](std::size_t k) { return sizes[k]; }, 1, tolerance);
}

double trusted_length(std::span<const double> c, double tolerance) {
  return length(
      c.size(), [&](std::size_t k) { return std::abs(c[k]); }, 0, tolerance);
}

}  // namespace mechanics::inline motions
