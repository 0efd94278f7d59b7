#include "mechanics/liquid/liquid_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "convex/mistakes.hpp"

namespace mechanics::liquid {
namespace {

using convex::InvalidInput;
using expression::no_node;
using expression::NodeId;

/// The parts of the boundary in the order in which they are tried.
std::vector<BoundaryPart> read_parts(LiquidLanguage& language, const LiquidText& text) {
  std::vector<BoundaryPart> parts;
  convex::Mistakes mistakes;
  for (const bool is_free : {true, false})
    for (const PartText& part : is_free ? text.free : text.walls) {
      const std::string what = (is_free ? "free." : "walls.") + part.name.text;
      const auto value = [&] {
        return language.field(part.value, what + (is_free ? ".pressure" : ".acceleration"));
      };
      const bool is_read = mistakes.gather([&] {
        parts.push_back({part.name.text, is_free, Condition(language, part.where, what + ".where"), value(),
                         part.name.begin});
      });
      if (!is_read) mistakes.gather(value);
    }
  mistakes.tell();
  return parts;
}

}  // namespace

const BoundaryPart* LiquidScene::part_at(const Point& x) const {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const BoundaryPart& part) {
    return part.where.holds(x, domain.reach());
  });
  return found == parts.end() ? nullptr : &*found;
}

const BoundaryPart& LiquidScene::boundary_part(const Point& x) const {
  if (const BoundaryPart* part = part_at(x)) return *part;
  throw InvalidInput("the boundary point " + point_text(coordinates, x) +
                     " lies in no part of free or walls; add a part that claims it, such as rest = { where = "
                     "\"true\", … }");
}

double LiquidScene::free_pressure(const BoundaryPart& part, const Point& x) const {
  const double pressure = part.value(x);
  // Where rounding of its terms decides it is 0.
  const double most = part.value.range({{{x[0], x[0]}, {x[1], x[1]}, {x[2], x[2]}}}).high;
  if (pressure < 0 && most >= 0 && std::isfinite(most)) return 0;
  if (pressure < 0) {
    char number[32];
    std::snprintf(number, sizeof number, "%.6g", pressure);
    throw InvalidInput(
        "free." + part.name + ".pressure: " + number + " at " + point_text(coordinates, x) +
            " is below 0, a tension that a liquid which parts does not bear; give a pressure >= 0",
        part.place);
  }
  return pressure;
}

expression::Range LiquidScene::wall_flux_range(const BoundaryPart& part, const Region& x,
                                               const Point& n) const {
  using expression::Operation, expression::Range;
  Range along = expression::value(Operation::negate, part.value.range(x), {});
  for (std::size_t i = 0; i < force.size(); ++i)
    if (n[i] != 0)
      along = expression::value(Operation::add, along,
                                expression::value(Operation::multiply, Range{n[i], n[i]}, force[i].range(x)));
  return expression::value(Operation::multiply, range_of(written_density), along);
}

LiquidScene LiquidScene::bounded(Bound side) const {
  LiquidScene made = *this;
  made.bound = side;
  made.h = h.bounded(side);
  for (BoundaryPart& part : made.parts)
    if (part.is_free) part.value = part.value.bounded(side);
  return made;
}

double LiquidScene::wall_flux(const BoundaryPart& part, const Point& x, const Point& n) const {
  if (bound != Bound::none)
    return end_of(wall_flux_range(part, {{{x[0], x[0]}, {x[1], x[1]}, {x[2], x[2]}}}, n), bound);
  double along = 0;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (n[i] != 0) along += n[i] * force[i](x);
  return density * (along - part.value(x));
}

bool LiquidScene::wall_leaves(const BoundaryPart& part, const Point& near) const {
  constexpr double digits = 1e-8;
  const Point x = domain.foot(near), n = domain.outward(x);
  double size = std::abs(part.value(x));
  for (std::size_t i = 0; i < force.size(); ++i) size += std::abs(n[i] * force[i](x));
  return wall_flux(part, x, n) < -digits * density * size;
}

double LiquidScene::pressure_scale() const {
  constexpr int points = 9;
  const double side = domain.longest();
  double scale = 0;
  const auto offer = [&](double value) {
    if (std::isfinite(value)) scale = std::max(scale, std::abs(value));
  };
  for (int code = 0; code < points * points * points; ++code) {
    const std::array<int, 3> place{code % points, code / points % points, code / points / points};
    Point x{};
    bool is_new = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
      is_new = is_new && (i < dimension() || place[i] == 0);
      if (i < dimension())
        x[i] = domain.low[i] + (domain.high[i] - domain.low[i]) * (place[i] + 0.5) / points;
    }
    if (!is_new || domain.level(x) > 0) continue;
    offer(h.raw(x) * side * side / 8);
    for (const BoundaryPart& part : parts) offer(part.value.raw(x) * (part.is_free ? 1 : density * side));
    if (has_wall())
      for (const Field& along : force) offer(along.raw(x) * density * side);
  }
  return scale;
}

bool LiquidScene::has_free_part() const {
  return std::any_of(parts.begin(), parts.end(), [](const BoundaryPart& part) { return part.is_free; });
}

bool LiquidScene::has_wall() const {
  return std::any_of(parts.begin(), parts.end(), [](const BoundaryPart& part) { return !part.is_free; });
}

void LiquidScene::require_no_divergence(const Point& x) const {
  using expression::Operation, expression::Range, expression::value;
  double divergence = 0, size = 0;
  Range by_rounding{0, 0};
  for (const Field& stretch : stretching) {
    const double rate = stretch(x);
    divergence += rate;
    size += std::abs(rate);
    by_rounding = value(Operation::add, by_rounding,
                        stretch.range({Range{x[0], x[0]}, Range{x[1], x[1]}, Range{x[2], x[2]}}));
  }
  const bool is_rounding = by_rounding.contains(0) && std::isfinite(by_rounding.high - by_rounding.low);
  // What expressions of some hundred operations round; and where each rate is what is left of terms that
  // cancel, what it may be.
  constexpr double rounding = 1e-12;
  if (std::abs(divergence) <= rounding * size || is_rounding) return;
  char number[32];
  std::snprintf(number, sizeof number, "%.6g", divergence);
  throw InvalidInput("velocity: its divergence is " + std::string(number) + " at " +
                         point_text(coordinates, x) +
                         ", where the liquid has no cavity; give a velocity whose divergence is 0 there",
                     velocity.front().place());
}

expression::Range LiquidScene::load_range(const expression::Range& x) const {
  using expression::Operation, expression::Range, expression::value;
  const Region at{x, Range{0, 0}, Range{0, 0}};
  Range sum{0, 0};
  const auto plus = [&](const Range& term) { sum = value(Operation::add, sum, term); };
  if (!stretching.empty()) {
    const Range rate = stretching.front().range(at),
                length = value(Operation::subtract, {x.high, x.high}, {x.low, x.low});
    plus(value(Operation::multiply, value(Operation::multiply, rate, rate), {0, length.high}));
  }
  if (!force.empty()) {
    const Range along = force.front().range(at);
    plus(value(Operation::subtract, along, along));
  }
  return value(Operation::multiply, sum, range_of(written_density));
}

LiquidScene read_scene(const LiquidText& text) {
  LiquidLanguage language(text.coordinates, text.parameters, text.range);
  LiquidScene scene;
  const std::size_t d = text.coordinates.size();
  scene.coordinates = language.coordinates();
  convex::Mistakes mistakes;
  mistakes.gather([&] { scene.domain = read_domain(language, text); });
  mistakes.gather([&] {
    scene.density = language.number(text.density, "density");
    scene.written_density = language.rounded(text.density, "density");
    if (!(scene.density > 0))
      throw InvalidInput("density: it is not above 0; give a density > 0", text.density.begin);
  });
  std::vector<std::vector<NodeId>> gradient(d, std::vector<NodeId>(d, no_node));  // ∂u_i/∂x_j
  for (std::size_t i = 0; i < text.velocity.size(); ++i)
    mistakes.gather([&] {
      const NodeId velocity = language.node(text.velocity[i], "velocity");
      scene.velocity.push_back(language.field(velocity, "velocity", text.velocity[i].begin));
      gradient[i] = language.gradient(velocity);
    });
  NodeId trace = no_node, divergence = no_node;
  for (std::size_t i = 0; i < d; ++i) {
    for (std::size_t j = 0; j < d; ++j)
      trace = language.sum(trace, language.product(gradient[i][j], gradient[j][i]));
    scene.stretching.push_back(language.field(gradient[i][i], "velocity", text.domain.begin));
    if (text.force.empty()) continue;
    mistakes.gather([&] {
      const NodeId force = language.node(text.force[i], "force");
      scene.force.push_back(language.field(force, "force", text.force[i].begin));
      divergence = language.sum(divergence, language.gradient(force)[i]);
    });
  }
  const NodeId source = language.difference(trace, divergence);
  if (source != no_node && mistakes.none())
    scene.h = language.field(language.product(language.node(text.density, "density"), source),
                             "rho (tr((grad u)^2) - div F)",
                             text.force.empty() ? text.velocity.front().begin : text.force.front().begin);
  mistakes.gather([&] { scene.parts = read_parts(language, text); });
  mistakes.tell();
  scene.cells = text.cells;
  if (text.symmetry) {
    if (text.symmetry->text != "radial")
      throw InvalidInput(
          "symmetry: \"" + text.symmetry->text + "\" is unknown; write \"radial\" or leave it out",
          text.symmetry->begin);
    scene.radial = true;
  }
  return scene;
}

LiquidText with_parameter(LiquidText text, const std::string& name, double value) {
  char number[40];
  std::snprintf(number, sizeof number, "%.17g", value);
  for (NamedText& parameter : text.parameters)
    if (parameter.name.text == name) parameter.value.text = number;
  return text;
}

double parameter_value(const LiquidText& text, const std::string& name) {
  return LiquidLanguage(text.coordinates, text.parameters).parameter(name);
}

}  // namespace mechanics::liquid
