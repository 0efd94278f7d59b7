#include "mechanics/liquid/onset.hpp"

#include <array>
#include <cmath>
#include <functional>

#include "convex/invalid_input.hpp"
#include "mechanics/liquid/grid_scene.hpp"
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

/// A change of sign around a value, searched for in steps that double.
std::optional<std::pair<double, double>> near_bracket(const Sign& f, double value, double step) {
  for (int doubling = 0; doubling < 30; ++doubling, step *= 2) {
    const std::optional<double> low = f(value - step), high = f(value + step);
    if (low && high && (*low < 0) != (*high < 0)) return std::pair{value - step, value + step};
    if (!low && !high) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<LiquidOnset> find_onset(const LiquidText& text, const std::string& parameter,
                                      const LiquidAccuracy& accuracy) {
  const double start = parameter_value(text, parameter);
  const auto least_on = [&](long cells) -> Sign {
    return [&text, &parameter, cells](double value) -> std::optional<double> {
      try {
        const LiquidScene scene = read_scene(with_parameter(text, parameter, value));
        if (const std::optional<LineScene> line = as_line(scene)) return least_line_pressure(*line);
        return least_grid_pressure(scene, cells);
      } catch (const convex::InvalidInput&) {
        return std::nullopt;
      }
    };
  };
  const LiquidScene scene = read_scene(text);
  const std::array<long, 3> first_cells{64, 32, 8}, most_cells{1024, 512, 64};
  const std::size_t axis = scene.dimension() - 1;
  const auto found = bracket(least_on(first_cells[axis]), start);
  if (!found) return std::nullopt;
  constexpr double rounding = 1e-15;
  if (as_line(scene)) {
    LiquidOnset onset = root(least_on(0), found->first, found->second, rounding);
    // What rounding in the least pressure moves the root by is far below this.
    onset.error += 1e-12 * std::max(std::abs(onset.value), std::abs(start));
    return onset;
  }
  // On finer grids the root is near that of the one before; two of them tell how near.
  constexpr double solve_accuracy = 1e-8;
  const std::array<long, 3> second_cells{128, 64, 16};
  LiquidOnset before = root(least_on(first_cells[axis]), found->first, found->second, solve_accuracy),
              onset = before;
  double step = 0.05 * std::max(std::abs(before.value), 1e-3 * std::abs(start));
  for (long cells = second_cells[axis]; cells <= most_cells[axis]; cells *= 2) {
    const Sign least = least_on(cells);
    const auto near = near_bracket(least, before.value, step);
    if (!near) return std::nullopt;
    const LiquidOnset here = root(least, near->first, near->second, solve_accuracy);
    const double change = here.value - before.value;
    // As far as the error is of second order a third of the change is left.
    onset = {here.value + change / 3, std::abs(change) + solve_accuracy * std::abs(here.value)};
    before = here;
    step = std::max(2 * std::abs(change), 1e-6 * std::abs(here.value));
    const double asked = accuracy.part() * std::abs(onset.value);
    if (cells > second_cells[axis] && 4 * onset.error <= asked) break;
  }
  return onset;
}

}  // namespace mechanics::liquid
