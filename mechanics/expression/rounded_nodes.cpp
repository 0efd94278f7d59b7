#include "mechanics/expression/rounded_nodes.hpp"

#include <algorithm>
#include <bit>
#include <cctype>

#include "mechanics/expression/exact_jet.hpp"

namespace mechanics::expression {
namespace {

constexpr double pi_radius = 1.23e-16;  // π - the double nearest to it is 1.2246e-16

double rounding_of_literal(double number) { return std::max(std::abs(number) * 0x1p-53, lost_below); }

}  // namespace

std::string text_with_radius(const std::string& number, double radius) {
  return number + radius_mark + std::to_string(std::bit_cast<std::uint64_t>(radius));
}

std::string text_of_fraction(const std::string& number, const convex::Fraction& exact) {
  const double rounded = convex::nearest_double(exact), radius = rounding_of_literal(rounded);
  return text_with_radius(number, convex::fraction(rounded) == exact ? 0 : radius) + radius_mark +
         convex::text(exact);
}

/// Half a unit of the last place, unless the text is that double exactly or says its radius.
Rounded rounded_literal(const Tape& tape, NodeId node) {
  const double number = tape.constant(node);
  const std::string& text = tape.text(node);
  if (const std::size_t mark = text.find(radius_mark); mark != std::string::npos)
    return {number, std::bit_cast<double>(std::uint64_t{std::stoull(text.substr(mark + 1))})};
  constexpr std::size_t digits_of_doubles = 15;
  const bool is_short = text.size() <= digits_of_doubles;
  if (is_short && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
    return number;
  const auto written = literal_value(tape, node);
  if (written && std::isfinite(number) && *written == convex::fraction(number)) return number;
  return {number, rounding_of_literal(number)};
}

std::vector<Rounded> rounded_nodes(const Tape& tape, Rounded t) {
  std::vector<Rounded> numbers(tape.size());
  for (NodeId node = 0; node < tape.size(); ++node) {
    if ((tape.depends(node) & (on_coordinates | on_velocities)) != 0) continue;
    switch (const Operation operation = tape.operation(node)) {
      case Operation::literal:
        numbers[node] = rounded_literal(tape, node);
        break;
      case Operation::pi:
        numbers[node] = {tape.constant(node), pi_radius};
        break;
      case Operation::time:
        numbers[node] = t;
        break;
      default:
        numbers[node] = value(operation, numbers[tape.a(node)], numbers[tape.b(node)]);
    }
  }
  return numbers;
}

}  // namespace mechanics::expression
