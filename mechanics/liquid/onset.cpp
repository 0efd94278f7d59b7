#include "mechanics/liquid/onset.hpp"

#include <array>
#include <cmath>
#include <functional>

#include "mechanics/liquid/first_change.hpp"
#include "mechanics/liquid/grid_error.hpp"
#include "mechanics/liquid/line_scene.hpp"
#include "mechanics/liquid/parameter_family.hpp"

namespace mechanics::liquid {
namespace {

using Sign = std::function<std::optional<RoundedValue>(double)>;

/// Halving with the secant where it does better; f(a) and f(b) differ in sign.
LiquidOnset root(const Sign& f, double a, double b, double accuracy, double least_size) {
  double fa = f(a)->value, fb = f(b)->value;
  if ((fa < 0) == (fb < 0)) return {0.5 * (a + b), std::abs(b - a)};  // rounding hides the sign at an end
  int stuck = 0;
  while (std::abs(b - a) > accuracy * std::max({std::abs(a), std::abs(b), least_size})) {
    double x = stuck < 2 ? (a * fb - b * fa) / (fb - fa) : 0.5 * (a + b);
    // A step towards the far end makes the interval short once the root is nearly known.
    if (!(std::min(a, b) < x && x < std::max(a, b))) x = 0.5 * (a + b);
    if (x == a || x == b) break;
    const std::optional<RoundedValue> found = f(x);
    if (!found) break;
    const double value = found->value;
    const double width = std::abs(b - a);
    if ((value < 0) == (fa < 0)) {
      a = x;
      fa = value;
    } else {
      b = x;
      fb = value;
    }
    stuck = std::abs(b - a) > 0.5 * width ? stuck + 1 : 0;
  }
  return {0.5 * (a + b), std::abs(b - a)};
}

/// How far from its root the least pressure leaves what rounding may have done to it.
double rounding_error(const ParameterFamily& family, double root, double size) {
  const std::optional<RoundedValue> there = family.least(root, 0);
  const double rounding = there ? there->rounding : 0;
  double reach = 1e-13 * size;
  const auto is_near = [&](double value) {
    const std::optional<RoundedValue> least = family.least(value, 0);
    return least && std::abs(least->value) <= rounding;
  };
  while (reach < size && (is_near(root - reach) || is_near(root + reach))) reach *= 2;
  return reach;
}

/// A change of sign around a value, searched for in steps that double.
std::optional<std::pair<double, double>> near_bracket(const Sign& f, double value, double step) {
  for (int doubling = 0; doubling < 30; ++doubling, step *= 2) {
    const std::optional<RoundedValue> low = f(value - step), high = f(value + step);
    if (low && high && (low->value < 0) != (high->value < 0)) return std::pair{value - step, value + step};
    if (!low && !high) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

OnsetSearch find_onset(const LiquidText& text, const std::string& parameter, const LiquidAccuracy& accuracy) {
  const double start = parameter_value(text, parameter);
  const ParameterFamily family(text, parameter);
  const auto least_on = [&](long cells) -> Sign {
    return [&family, cells](double value) { return family.least(value, cells); };
  };
  const LiquidScene scene = read_scene(text);
  const std::array<long, 3> first_cells{64, 32, 8}, most_cells{1024, 512, 64};
  const std::size_t axis = scene.dimension() - 1;
  const bool is_line = as_line(scene).has_value();
  SignedFamily searched{least_on(first_cells[axis]), {}};
  if (family.has_bounds())
    searched.keeps_sign = [&](double low, double high, bool negative) {
      return family.keeps_sign(low, high, negative, first_cells[axis]);
    };
  constexpr double finest_on_grids = 0x1p-12;
  if (!is_line) searched.finest = finest_on_grids;
  const FirstChange found = find_first_change(searched, start);
  OnsetSearch made{std::nullopt, found.unshown, !family.has_bounds()};
  if (!found.between) return made;
  constexpr double rounding = 1e-15;
  const double least_size = 1e-6 * std::abs(start);  // of a root beside 0
  if (is_line) {
    made.onset = root(least_on(0), found.between->first, found.between->second, rounding, least_size);
    made.onset->error +=
        rounding_error(family, made.onset->value, std::max(std::abs(made.onset->value), least_size));
    return made;
  }
  // On finer grids the root is near that of the one before; two of them tell how near.
  constexpr double solve_accuracy = 1e-8;
  const std::array<long, 3> second_cells{128, 64, 16};
  LiquidOnset before = root(least_on(first_cells[axis]), found.between->first, found.between->second,
                            solve_accuracy, least_size);
  std::vector<double> changes;  // finest first
  double step = 1e-4 * std::max(std::abs(before.value), 1e-3 * std::abs(start));
  for (long cells = second_cells[axis]; cells <= most_cells[axis]; cells *= 2) {
    const Sign least = least_on(cells);
    const auto near = near_bracket(least, before.value, step);
    if (!near) return {std::nullopt, before.value, made.is_sampled};
    const LiquidOnset here = root(least, near->first, near->second, solve_accuracy, least_size);
    const double change = here.value - before.value;
    changes.insert(changes.begin(), std::abs(change));
    // As far as the error is of second order a third of the change is left.
    made.onset = {here.value + change / 3,
                  std::max(std::abs(change), error_by_differences(scene, changes, cells)) +
                      solve_accuracy * std::max(std::abs(here.value), least_size)};
    before = here;
    step = std::max(2 * std::abs(change), 1e-6 * std::abs(here.value));
    const double asked = accuracy.part() * std::abs(made.onset->value);
    if (cells > second_cells[axis] && 4 * made.onset->error <= asked) break;
  }
  return made;
}

}  // namespace mechanics::liquid
