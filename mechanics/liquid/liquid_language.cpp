#include "mechanics/liquid/liquid_language.hpp"

#include <algorithm>
#include <cmath>

#include "convex/interval_arithmetic.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"
#include "mechanics/expression/gradient_nodes.hpp"
#include "mechanics/expression/rounded_nodes.hpp"
#include "mechanics/expression/simplification.hpp"

namespace mechanics::liquid {

using expression::Name;
using expression::no_node;
using expression::NodeId;
using expression::Operation;
using expression::Vocabulary;

void LiquidLanguage::declare(const Text& text, const char* what, Name meaning) {
  const expression::Source& key = sources_.add(text, what);
  const expression::KeyName name = expression::parse_key_name(key);
  if (name.indices > 0) key.fail(0, "a name with an index; a liquid has none, write a plain name");
  names_.declare(name.name, meaning, key, 0);
}

LiquidLanguage::LiquidLanguage(const std::vector<Text>& coordinates, const std::vector<NamedText>& parameters,
                               const std::optional<ParameterRange>& range)
    : expansion_(meanings_, tape_) {
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    declare(parameters[p].name, "parameters", {Name::Kind::parameter, static_cast<std::uint32_t>(p), 0});
    meanings_.parameter_names.push_back(parameters[p].name.text);
  }
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    declare(coordinates[i], "coordinates", {Name::Kind::coordinate, static_cast<std::uint32_t>(i), 0});
    coordinates_.push_back(coordinates[i].text);
    meanings_.coordinate_families.push_back(
        {coordinates[i].text, expression::Members(), static_cast<std::uint32_t>(i)});
  }
  for (const NamedText& p : parameters)
    meanings_.parameters.push_back(expression::parse_expression(
        sources_.add(p.value, "parameter " + p.name.text), {&names_, Vocabulary::parameters, {}}));
  if (range) give_range(*range);
  for (std::uint32_t p = 0; p < parameters.size(); ++p)
    if (const NodeId node = expansion_.parameter(p); !std::isfinite(tape_.constant(node)))
      throw convex::InvalidInput("parameter " + parameters[p].name.text + ": not a finite number",
                                 parameters[p].value.begin);
}

/// A number beside the middle, so that it is none at which an expression has another form (0, 1, 2).
void LiquidLanguage::give_range(const ParameterRange& range) {
  constexpr double beside = 0.49993;
  const double centre = range.low + beside * (range.high - range.low),
               radius = convex::moved_up(std::max(range.high - centre, centre - range.low));
  const auto& names = meanings_.parameter_names;
  for (std::uint32_t p = 0; p < names.size(); ++p) {
    if (names[p] != range.name) continue;
    const NodeId all =
        tape_.literal(expression::text_with_radius(expression::shortest_digits(centre), radius), centre, {});
    tape_.keep_choices();
    expansion_.give_parameter(p, tape_.parameter(range.name, all, {}));
  }
}

NodeId LiquidLanguage::node(const Text& text, const std::string& what) {
  const expression::Source& source = sources_.add(text, what);
  const expression::Code code = expression::parse_expression(source, {&names_, Vocabulary::system, {}});
  const NodeId node = expansion_.node(code, {});
  if ((tape_.depends(node) & (expression::on_time | expression::on_velocities)) != 0)
    source.fail(0,
                "it uses t or a time derivative; a liquid is asked about at one instant, write it in the "
                "coordinates and parameters");
  return node;
}

double LiquidLanguage::number(const Text& text, const std::string& what) {
  const NodeId found = node(text, what);
  if (!tape_.is_constant(found))
    throw convex::InvalidInput(what +
                                   ": it depends on a coordinate; give a number or an expression in the "
                                   "parameters",
                               text.begin);
  if (const double value = tape_.constant(found); std::isfinite(value)) return value;
  throw convex::InvalidInput(what + ": not a finite number", text.begin);
}

expression::Rounded LiquidLanguage::rounded(const Text& text, const std::string& what) {
  number(text, what);
  return expression::rounded_nodes(tape_)[node(text, what)];
}

Field LiquidLanguage::field(const Text& text, const std::string& what) {
  return field(node(text, what), what, text.begin);
}

Field LiquidLanguage::field(NodeId node, const std::string& what, convex::Place place) const {
  return node == no_node ? Field() : Field(tape_, node, coordinates_, what, place);
}

NodeId LiquidLanguage::sum(NodeId a, NodeId b) {
  if (a == no_node || b == no_node) return a == no_node ? b : a;
  return tape_.apply(Operation::add, a, b, tape_.origin(a));
}

NodeId LiquidLanguage::difference(NodeId a, NodeId b) {
  if (b == no_node) return a;
  return a == no_node ? tape_.apply(Operation::negate, b, b, tape_.origin(b))
                      : tape_.apply(Operation::subtract, a, b, tape_.origin(a));
}

NodeId LiquidLanguage::product(NodeId a, NodeId b) {
  return a == no_node || b == no_node ? no_node : tape_.apply(Operation::multiply, a, b, tape_.origin(a));
}

std::vector<NodeId> LiquidLanguage::gradient(NodeId node) {
  std::vector<NodeId> by_coordinate(coordinates_.size(), no_node);
  if (node == no_node) return by_coordinate;
  for (const auto& [i, slope] : expression::gradient_nodes(tape_, node).by_coordinate)
    by_coordinate[i] = tape_.is_constant(slope) && tape_.constant(slope) == 0 ? no_node : slope;
  return by_coordinate;
}

double LiquidLanguage::parameter(const std::string& name) {
  const auto& names = meanings_.parameter_names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw convex::InvalidInput("no parameter \"" + name + "\" in [liquid.parameters]" +
                               (names.empty() ? "; give it there" : "; " + convex::suggestion(name, names)));
  return tape_.constant(expansion_.parameter(static_cast<std::uint32_t>(found - names.begin())));
}

}  // namespace mechanics::liquid
