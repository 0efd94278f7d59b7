#include "mechanics/motion/step_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/vector.hpp"
#include "mechanics/motion/terms.hpp"

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

/// Σ of |c_k| h^k from k = 1, of the coefficients of one sign or of both: four sums in h⁴, which need not
/// wait for each other.
template <class Part>
double majorant(std::span<const double> c, double h, Part part) {
  constexpr std::size_t sums = 4;
  const double square = h * h, fourth = square * square;
  double sum[sums] = {};
  const std::size_t end = (c.size() - 1) / sums * sums;
  for (std::size_t k = c.size(); k-- > end + 1;) sum[k - end - 1] = part(c[k]);
  for (std::size_t k = end; k > 0; k -= sums)
    for (std::size_t i = 0; i < sums; ++i) sum[i] = sum[i] * fourth + part(c[k - sums + 1 + i]);
  return h * ((sum[0] + sum[1] * h) + square * (sum[2] + sum[3] * h));
}

/// Without zeros at the end, and without what has left the range of doubles.
std::span<const double> without_end(std::span<const double> c) {
  std::size_t count = c.size();
  while (count > 1 && (c[count - 1] == 0 || !std::isfinite(c[count - 1]))) --count;
  return c.first(count);
}

/// The h at which that comes to a bound > 0, from below: a majorant grows faster than h.
template <class Part>
double length_of_majorant(std::span<const double> c, double bound, Part part) {
  double longest = std::numeric_limits<double>::infinity();  // each term is within the bound
  for (std::size_t k = 1; k < c.size(); ++k)
    if (const double size = part(c[k]); size > 0)
      longest = std::min(longest, k == 1 ? bound / size : std::pow(bound / size, 1 / static_cast<double>(k)));
  if (!std::isfinite(longest) || c.size() == 2) return longest;
  double low = 0.5 * longest, high = longest;  // at half of it they are a geometric series
  constexpr int cuts = 8;
  for (int i = 0; i < cuts; ++i) {
    const double middle = 0.5 * (low + high), sum = majorant(c, middle, part);
    if (sum <= bound)
      low = middle;
    else {
      high = middle;
      low = std::max(low, middle * (bound / sum));
    }
  }
  return low;
}

}  // namespace

double reach_of_argument(int order, double tolerance) {
  constexpr double room = 1.25;
  return room * std::exp((std::lgamma(order + 1.0) + std::log(tolerance)) / order);
}

double seen_length(std::span<const double> argument, TaylorStep::Kind of, double step, double reach) {
  const std::span<const double> u = without_end(argument);
  const auto size = [](double c) { return std::abs(c); };
  const auto up = [](double c) { return std::max(c, 0.0); };
  const auto down = [](double c) { return std::max(-c, 0.0); };
  const bool has_poles = of == TaylorStep::Kind::tangent || of == TaylorStep::Kind::tanh;
  const double most = has_poles ? 1 : reach;
  if (std::isfinite(step) && sum_of_terms(u, step) <= most) return step;
  double longest = length_of_majorant(u, most, size);
  // exp(-746) is 0, exp(710) and cosh(711) are infinite, on a branch that is not taken or below a fraction,
  // and 1 - tanh² at 40 is e^-80.
  constexpr double least_logarithm = 746, most_logarithm = 710, end_of_cosh = 711, end_of_tanh = 40;
  const auto stays_below = [&](double bound) {
    if (u[0] < bound) longest = std::max(longest, length_of_majorant(u, bound - u[0], up));
  };
  const auto stays_above = [&](double bound) {
    if (u[0] > bound) longest = std::max(longest, length_of_majorant(u, u[0] - bound, down));
  };
  if (of == TaylorStep::Kind::exponential) {
    stays_below(-least_logarithm);
    stays_above(most_logarithm);
  }
  if (of == TaylorStep::Kind::sinh) {
    stays_below(-end_of_cosh);
    stays_above(end_of_cosh);
  }
  if (of == TaylorStep::Kind::tanh) {
    stays_below(-end_of_tanh);
    stays_above(end_of_tanh);
  }
  return std::min(step, longest);
}

double step_length(std::span<const double> sizes, double tolerance) {
  return length(
      sizes.size(), [&](std::size_t k) { return sizes[k]; }, 1, tolerance);
}

double trusted_length(std::span<const double> c, double tolerance) {
  return length(
      c.size(), [&](std::size_t k) { return std::abs(c[k]); }, 0, tolerance);
}

}  // namespace mechanics::inline motions
