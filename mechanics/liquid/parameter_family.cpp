#include "mechanics/liquid/parameter_family.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "convex/invalid_input.hpp"
#include "mechanics/liquid/grid_scene.hpp"
#include "mechanics/liquid/line_scene.hpp"

namespace mechanics::liquid {
namespace {

using convex::Index;
using convex::LineEnd;
using expression::Operation;
using expression::Range;

/// Whether a name stands in a text, by itself or in a parameter that stands there.
bool uses(const std::string& text, const std::string& name, const std::vector<NamedText>& parameters,
          std::size_t depth = 0) {
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t begin = 0; begin < text.size();) {
    if (!is_letter(text[begin])) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < text.size() && is_letter(text[end])) ++end;
    const std::string word = text.substr(begin, end - begin);
    if (word == name) return true;
    for (const NamedText& other : parameters)
      if (other.name.text == word && depth < parameters.size() &&
          uses(other.value.text, name, parameters, depth + 1))
        return true;
    begin = end;
  }
  return false;
}

Range product(Range a, Range b) { return expression::value(Operation::multiply, a, b); }
Range sum(Range a, Range b) { return expression::value(Operation::add, a, b); }

/// The ends of an interval, or 0 and the radius of a ball, for all values of the parameter.
std::pair<Range, Range> ends(const LiquidScene& scene, const LineScene& line) {
  const Domain& domain = scene.domain;
  const Range first = range_of(domain.written[0]);
  if (domain.shape == Domain::Shape::box) return {first, range_of(domain.written[1])};
  if (line.radial) return {{0, 0}, first};
  const Range centre = range_of(domain.written_centre[0]);
  return {expression::value(Operation::subtract, centre, first), sum(centre, first)};
}

/// The line on 0 <= s <= 1, r = a + ℓ s, where -(s^k p')' = s^k ℓ² h: with the ends of its data.
convex::LineObstacle bounding_line(const LiquidScene& scene, const LineScene& line, Bound bound) {
  const auto [a, b] = ends(scene, line);
  const Range length = expression::value(Operation::subtract, b, a), square = product(length, length);
  Ray from{};
  if (line.radial) from = scene.domain.written_centre;
  convex::LineObstacle made = line.problem;
  made.low = 0;
  made.high = 1;
  made.h = [&scene, from, a = a, length, square, bound](double s) {
    const Region at = region(from, sum(a, product(length, {s, s})));
    return end_of(product(square, scene.h.range(at)), bound);
  };
  const auto give = [&](LineEnd& end, const BoundaryPart* part, Range r, double side) {
    if (end.kind == LineEnd::Kind::centre) return;
    const Region at = region(from, r);
    end.value = end_of(part->is_free ? part->value.range(at)
                                     : product(length, scene.wall_flux_range(*part, at, {side, 0, 0})),
                       bound);
  };
  give(made.at_low, line.low, a, -1);
  give(made.at_high, line.high, b, 1);
  return made;
}

bool is_finite(const convex::LineObstacle& line) {
  constexpr int points = 8;
  bool finite = std::isfinite(line.at_low.value) && std::isfinite(line.at_high.value);
  for (int k = 0; k <= points && finite; ++k)
    finite = std::isfinite(line.h(line.low + (line.high - line.low) * k / points));
  return finite;
}

}  // namespace

ParameterFamily::ParameterFamily(const LiquidText& text, std::string parameter)
    : text_(text), parameter_(std::move(parameter)) {
  const auto is_used = [&](const std::string& in) { return uses(in, parameter_, text_.parameters); };
  for (const auto* box : {&text_.low, &text_.high})
    for (const Text& one : *box) has_bounds_ = has_bounds_ && !is_used(one.text);
  for (const auto* parts : {&text_.free, &text_.walls})
    for (const PartText& part : *parts) has_bounds_ = has_bounds_ && !is_used(part.where.text);
  moves_domain_ = is_used(text_.domain.text);
  if (!moves_domain_ || !has_bounds_) return;
  try {
    const LiquidScene scene = read_scene(text_);
    const bool has_ends =
        scene.domain.shape == Domain::Shape::box || scene.domain.shape == Domain::Shape::ball;
    has_bounds_ = has_ends && as_line(scene).has_value();
  } catch (const convex::InvalidInput&) {
    has_bounds_ = false;
  }
}

std::optional<RoundedValue> ParameterFamily::least(double value, long cells) const {
  try {
    const LiquidScene scene = read_scene(with_parameter(text_, parameter_, value));
    if (const std::optional<LineScene> line = as_line(scene)) return least_line_pressure(line->problem);
    return RoundedValue{least_grid_pressure(scene, cells)};
  } catch (const convex::InvalidInput&) {
    return std::nullopt;
  }
}

bool ParameterFamily::keeps_sign(double low, double high, bool negative, long cells) const {
  const auto keeps = [&](double least) { return negative ? least < 0 : least >= 0; };
  const auto line_keeps = [&](convex::LineObstacle line) {
    constexpr Index most_cells = 2000;  // a shorter interval asks for fewer
    line.most_cells = most_cells;
    if (!is_finite(line)) return false;
    const RoundedValue least = least_line_pressure(line);
    return std::isfinite(least.rounding) && keeps(least.value);
  };
  const Bound bound = negative ? Bound::upper : Bound::lower;
  try {
    LiquidText text = text_;
    text.range = ParameterRange{parameter_, low, high};
    const LiquidScene scene = read_scene(text);
    const std::optional<LineScene> line = as_line(scene);
    if (!line) return !moves_domain_ && keeps(least_grid_pressure(scene.bounded(bound), cells));
    if (moves_domain_) return line_keeps(bounding_line(scene, *line, bound));
    const LiquidScene side = scene.bounded(bound);
    const std::optional<LineScene> bounded = as_line(side);
    return bounded && line_keeps(bounded->problem);
  } catch (const convex::InvalidInput&) {
    return false;
  }
}

}  // namespace mechanics::liquid
