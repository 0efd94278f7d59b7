#include <fmt/format.h>

#include "cli/report/atlas_report.hpp"
#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"
#include "convex/exact/fraction_arithmetic.hpp"

namespace cli::inline reports {
namespace {

using convex::atlas::Probability;

std::string contact_set(const SolvedAtlas& solved, const std::vector<std::size_t>& rows) {
  std::vector<std::string> names;
  for (const std::size_t a : rows) names.push_back(solved.contacts[a]);
  return names.empty() ? "none" : listed(names);
}

const char* plural(std::size_t count) { return count == 1 ? "" : "s"; }

std::string here_text(const SolvedAtlas& solved) {
  if (solved.here.empty()) return "";
  const auto& cells = solved.atlas.cells;
  std::string text = "the force of the file: " + contact_set(solved, cells[solved.here.front()].rows);
  if (solved.here.size() > 1) text += fmt::format(", on the edge of {} cells", solved.here.size());
  text += "\n";
  for (const AtlasMargin& margin : margins(solved)) {
    std::string change;
    if (!margin.closing.empty()) change += "closes " + contact_set(solved, margin.closing);
    if (!margin.opening.empty())
      change += (change.empty() ? "" : ", ") + ("opens " + contact_set(solved, margin.opening));
    text += fmt::format("  {} from where it {}\n", number_text(margin.distance), change);
  }
  return text;
}

std::string rule_text(const SolvedAtlas& solved) {
  if (solved.contacts.empty()) return "";
  if (!solved.rule)
    return "The rule of dropping negative multipliers has no multipliers to go by: the contacts depend on "
           "each "
           "other.\n";
  const auto part = [](const Probability& p) { return fmt::format("{:.6f} (+- {:.0e})", p.value, p.error); };
  return fmt::format(
      "All contacts persist with the probability {}. Dropping those with a negative multiplier is right "
      "with\n"
      "{}, wrong with {}.\n",
      part(solved.rule->accepted), part(solved.rule->right), part(solved.rule->wrong));
}

std::string map_text(const SolvedAtlas& solved) {
  const AtlasMap& map = *solved.map;
  std::vector<std::string> ranges;
  for (const ForceRange& range : map.over)
    ranges.push_back(fmt::format("{} from {} to {}", range.key,
                                 number_text(convex::nearest_double(range.low)),
                                 number_text(convex::nearest_double(range.high))));
  std::string text = "\nover " + listed(ranges) + ", added to the force of the file\n";
  TextTable table({"contacts that persist", "part of the map"});
  for (const convex::atlas::PlaneRegion& region : map.regions)
    table.add({contact_set(solved, solved.atlas.cells[region.cell].rows),
               fmt::format("{:.9f}", convex::nearest_double(region.polygon.area) / map.area())});
  text += table.text();
  if (const auto rule = map.rule(solved.atlas))
    text += fmt::format(
        "All contacts persist on {:.6f} of it; dropping negative multipliers is right on {:.6f}, wrong on "
        "{:.6f}.\n",
        rule->accepted, rule->right, rule->wrong);
  return text;
}

}  // namespace

std::string atlas_text(const SolvedAtlas& solved) {
  const convex::atlas::Atlas& atlas = solved.atlas;
  if (atlas.cells.empty())
    return "no acceleration satisfies the contacts: there is no cell. " +
           contact_set(solved, solved.culprits()) + " exclude each other.\n";
  std::string text = fmt::format("{} cell{} in {} dimension{}, {} wall{} between them\n", atlas.cells.size(),
                                 plural(atlas.cells.size()), atlas.space.rank, plural(atlas.space.rank),
                                 atlas.walls.size(), plural(atlas.walls.size()));
  if (!atlas.is_complete())
    text +=
        fmt::format("NOT all there are: explored from the file's force on, the walls of the first {} cells\n",
                    atlas.explored);
  const bool measured = !solved.probabilities.empty();
  std::vector<std::string> heading{"contacts that persist", "freedom", "walls"};
  if (measured) heading.insert(heading.end(), {"probability", "error at most"});
  TextTable table(heading);
  for (std::size_t c = 0; c < atlas.cells.size(); ++c) {
    const convex::atlas::Cell& cell = atlas.cells[c];
    std::vector<std::string> row{contact_set(solved, cell.rows), std::to_string(cell.freedom),
                                 std::to_string(cell.walls.size())};
    if (measured) {
      row.push_back(fmt::format("{:.9f}", solved.probabilities[c].value));
      row.push_back(fmt::format("{:.1e}", solved.probabilities[c].error));
    }
    table.add(std::move(row));
  }
  text += table.text();
  if (measured) {
    const Probability sum = solved.sum();
    text += fmt::format("{}; sum of all cells {:.12f}, sum of their bounds {:.1e}\n", solved.distribution,
                        sum.value, sum.error);
    if (!solved.is_accurate())
      text += fmt::format("NOT to the accuracy that was asked for, {:g} each.\n", solved.tolerance);
    text += rule_text(solved);
  }
  if (!solved.as_written)
    text += "Of the doubles that the mechanism evaluates to: rounding may show as thin cells.\n";
  return text + here_text(solved) + (solved.map ? map_text(solved) : "");
}

}  // namespace cli::inline reports
