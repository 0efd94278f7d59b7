#include "cli/problem_file/keys.hpp"
#include "cli/report/atlas_report.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline reports {

using convex::Fraction;
using convex::InvalidInput;
using convex::atlas::PlaneRegion;

ForceRange parse_force_range(const std::string& text, const std::vector<std::string>& coordinates) {
  const auto refuse = [&](const std::string& message) {
    throw InvalidInput("--over " + shown(text) + ": " + message);
  };
  const std::string prefix = "force.";
  const std::size_t equals = text.find('='), colon = text.find(':', equals);
  if (text.rfind(prefix, 0) != 0 || equals == std::string::npos || colon == std::string::npos)
    refuse(
        "no range of a force; write force.x=-5:5, a force on the coordinate x from -5 to 5, added to that of "
        "the file");
  ForceRange range;
  range.key = text.substr(0, equals);
  const std::string name = range.key.substr(prefix.size());
  while (range.coordinate < coordinates.size() && coordinates[range.coordinate] != name) ++range.coordinate;
  if (range.coordinate == coordinates.size())
    refuse("there is no coordinate " + shown(name) + "; " + convex::suggestion(name, coordinates));
  const auto low = convex::read_fraction(text.substr(equals + 1, colon - equals - 1)),
             high = convex::read_fraction(text.substr(colon + 1));
  if (!low || !high) refuse("a bound is no number; write force.x=-5:5");
  if (!(*low < *high)) refuse("the first bound is not below the second; write low:high");
  range.low = *low;
  range.high = *high;
  return range;
}

double AtlasMap::area() const {
  Fraction product{1, 1};
  for (const ForceRange& range : over) product = product * (range.high - range.low);
  return convex::nearest_double(product);
}

std::optional<AtlasMap::RuleParts> AtlasMap::rule(const convex::atlas::Atlas& atlas) const {
  if (!rule_is_defined(atlas)) return std::nullopt;
  Fraction accepted{0, 1}, right{0, 1}, wrong{0, 1}, whole{1, 1};
  for (const ForceRange& range : over) whole = whole * (range.high - range.low);
  for (const PlaneRegion& region : regions) {
    if (atlas.cells[region.cell].rows.size() == atlas.space.count()) {
      accepted = accepted + region.polygon.area;
      continue;
    }
    right = right + region.right->area;
    wrong = wrong + (region.polygon.area - region.right->area);
  }
  return RuleParts{convex::nearest_double(accepted / whole), convex::nearest_double(right / whole),
                   convex::nearest_double(wrong / whole)};
}

}  // namespace cli::inline reports
