#include "cli/drawing/drawn_range.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cli::inline drawings {
namespace {

constexpr double drawn_rounding = 1e-9;
/// Of numbers that a motion of many steps makes: some hundred roundings.
constexpr double rounding_beside = 1e-13;

}  // namespace

void DrawnRange::count_beside(double size) {
  if (std::isfinite(size)) rounding = std::max(rounding, rounding_beside * size);
}

void DrawnRange::add(double x) {
  if (!std::isfinite(x)) return;
  low = std::min(low, x);
  high = std::max(high, x);
}

double DrawnRange::size() const { return std::max(std::abs(low), std::abs(high)); }

bool DrawnRange::is_constant() const {
  return low <= high && high - low <= std::max(drawn_rounding * std::max(size(), drawn_rounding), rounding);
}

DrawnRange DrawnRange::with_room() const {
  if (!is_constant()) return *this;
  const double half = size() > std::max(drawn_rounding, rounding) ? 0.1 * size() : 1;
  return {low - half, high + half};
}

bool DrawnRange::begins_at_zero() const { return low >= -std::max(drawn_rounding * high, rounding); }

std::string tic_format(const char* axis, const DrawnRange& range) {
  // gnuplot writes six digits, and from a million on powers of ten, beside numbers without.
  constexpr double same_in_six = 1e4, before_million = 5e5, not_in_ten = 1e9;
  constexpr int usual = 10, most = 16, of_a_tic = 4;
  const double size = range.size(), times = size / (range.high - range.low);  // NaN of none
  if (!(times < INFINITY) || (times < same_in_six && !(size > before_million && size < not_in_ten)))
    return fmt::format("set format {}\n", axis);
  const int digits = std::clamp(of_a_tic + static_cast<int>(std::log10(times)), usual, most);
  return fmt::format("set format {} \"%.{}g\"\n", axis, digits);
}

}  // namespace cli::inline drawings
