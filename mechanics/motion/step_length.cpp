#include "mechanics/motion/step_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics {

double tolerance_of_step(double tolerance) {
  return std::max(part_of_a_step * tolerance, 0.5 * convex::unit_roundoff);
}

int taylor_order(double tolerance) {
  constexpr int least = 8, most = 28;
  return std::clamp(static_cast<int>(std::ceil(-0.5 * std::log(tolerance) + 1)) + 2, least, most);
}

namespace {

/// The largest of the first terms is what the last ones are compared with.
constexpr std::size_t compared_terms = 3;

/// By the sizes of coefficients 0, 1, …; those before `first` do not count.
double length(std::span<const double> size, std::size_t first, double tolerance) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::size_t last = size.size() - 1;
  std::size_t top = last;
  while (top > 0 && size[top] == 0) --top;
  if (2 * top <= last) return infinite;
  double shortest = infinite;
  for (const std::size_t k : {top, top - 1}) {
    if (size[k] == 0) continue;
    double longest = 0;
    for (std::size_t j = first; j < std::min(k, first + compared_terms); ++j)
      longest =
          std::max(longest, std::pow(tolerance * (size[j] / size[k]), 1.0 / static_cast<double>(k - j)));
    shortest = std::min(shortest, longest);
  }
  return shortest;
}

}  // namespace

double step_length(const Arc& arc, const convex::Metric& A, double tolerance) {
  std::vector<double> size;
  for (Index k = 0; k < arc.q.cols(); ++k) size.push_back(A.norm(arc.q.col(k)));
  return length(size, 1, tolerance);
}

double trusted_length(std::span<const double> c, double tolerance) {
  std::vector<double> size;
  for (const double x : c) size.push_back(std::abs(x));
  return length(size, 0, tolerance);
}

}  // namespace mechanics
