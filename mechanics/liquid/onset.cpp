#include "mechanics/liquid/onset.hpp"

#include <cmath>
#include <functional>

#include "convex/invalid_input.hpp"
#include "mechanics/liquid/line_scene.hpp"

namespace mechanics::liquid {
namespace {

using Sign = std::function<std::optional<double>(double)>;

/// Two values of the parameter, at most a step apart, between which the function passes 0.
std::optional<std::pair<double, double>> bracket(const Sign& f, double start) {
  constexpr double growth = 1.15;
  const double size = start == 0 ? 1 : std::abs(start);
  const std::optional<double> first = f(start);
  if (!first) return std::nullopt;
  double before = 0, sides[2]{-1, 1};
  bool is_open[2]{true, true};
  for (double distance = 1e-6 * size; distance < 1e6 * size; distance *= growth) {
    for (int side = 0; side < 2; ++side) {
      if (!is_open[side]) continue;
      const double value = start + sides[side] * distance;
      const std::optional<double> there = f(value);
      if (!there)
        is_open[side] = false;
      else if ((*there < 0) != (*first < 0))
        return std::pair{start + sides[side] * before, value};
    }
    before = distance;
  }
  return std::nullopt;
}

/// Halving with the secant where it does better; f(a) and f(b) differ in sign.
LiquidOnset root(const Sign& f, double a, double b, double accuracy) {
  double fa = *f(a), fb = *f(b);
  int stuck = 0;
  while (std::abs(b - a) > accuracy * std::max(std::abs(a), std::abs(b))) {
    double x = stuck < 2 ? (a * fb - b * fa) / (fb - fa) : 0.5 * (a + b);
    // A step towards the far end makes the interval short once the root is nearly known.
    if (!(std::min(a, b) < x && x < std::max(a, b))) x = 0.5 * (a + b);
    if (x == a || x == b) break;
    const std::optional<double> value = f(x);
    if (!value) break;
    const double width = std::abs(b - a);
    if ((*value < 0) == (fa < 0)) {
      a = x;
      fa = *value;
    } else {
      b = x;
      fb = *value;
    }
    stuck = std::abs(b - a) > 0.5 * width ? stuck + 1 : 0;
  }
  return {0.5 * (a + b), std::abs(b - a)};
}

}  // namespace

std::optional<LiquidOnset> find_onset(const LiquidText& text, const std::string& parameter,
                                      const LiquidAccuracy&) {
  const double start = parameter_value(text, parameter);
  const Sign least = [&](double value) -> std::optional<double> {
    try {
      const LiquidScene scene = read_scene(with_parameter(text, parameter, value));
      const std::optional<LineScene> line = as_line(scene);
      if (!line) return std::nullopt;
      return least_line_pressure(*line);
    } catch (const convex::InvalidInput&) {
      return std::nullopt;
    }
  };
  const auto found = bracket(least, start);
  if (!found) return std::nullopt;
  constexpr double rounding = 1e-15;
  LiquidOnset onset = root(least, found->first, found->second, rounding);
  // What rounding in the least pressure moves the root by is far below this.
  onset.error += 1e-12 * std::max(std::abs(onset.value), std::abs(start));
  return onset;
}

}  // namespace mechanics::liquid
