#include "cli/json_writer.hpp"
#include "cli/report/atlas_report.hpp"
#include "convex/exact/fraction_arithmetic.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::atlas::Cell;
using convex::atlas::Wall;

void write_names(JsonWriter& json, const std::vector<std::string>& names,
                 const std::vector<std::size_t>& chosen) {
  json.begin_array();
  for (const std::size_t k : chosen) json.value(names[k]);
  json.end_array();
}

void write_wall(JsonWriter& json, const SolvedAtlas& solved, const Wall& wall) {
  json.begin_object().key("cells").begin_array();
  json.value(static_cast<Index>(wall.tighter)).value(static_cast<Index>(wall.looser)).end_array();
  json.key("normal").numbers(solved.coordinates, convex::nearest({wall.normal, 1}));
  json.key("offset").value(convex::nearest_double(wall.offset));
  json.key("exact").begin_object().key("normal").begin_array();
  for (const convex::Integer& entry : wall.normal) json.value(entry.text());
  json.end_array().key("offset").value(text(wall.offset)).end_object();
  json.end_object();
}

void write_cell(JsonWriter& json, const SolvedAtlas& solved, std::size_t index) {
  const Cell& cell = solved.atlas.cells[index];
  json.begin_object().key("contacts");
  write_names(json, solved.contacts, cell.rows);
  json.key("freedom").value(cell.freedom);
  json.key("explored").value(index < solved.atlas.explored);
  if (!solved.probabilities.empty()) {
    const convex::atlas::Probability& p = solved.probabilities[index];
    json.key("probability").value(p.value).key("error_bound").value(p.error);
    json.key("closed_form").value(p.closed);
  }
  json.key("neighbours").begin_array();
  for (const std::size_t w : cell.walls) {
    const Wall& wall = solved.atlas.walls[w];
    json.value(static_cast<Index>(wall.tighter == index ? wall.looser : wall.tighter));
  }
  json.end_array().key("walls").begin_array();
  for (const std::size_t w : cell.walls) json.value(static_cast<Index>(w));
  json.end_array().end_object();
}

void write_here(JsonWriter& json, const SolvedAtlas& solved) {
  if (solved.here.empty()) {
    json.null();
    return;
  }
  json.begin_object()
      .key("z")
      .numbers(solved.coordinates, convex::nearest(solved.z))
      .key("cells")
      .begin_array();
  for (const std::size_t c : solved.here) json.value(static_cast<Index>(c));
  json.end_array().key("margins").begin_array();
  for (const AtlasMargin& margin : margins(solved)) {
    json.begin_object().key("cell").value(static_cast<Index>(margin.cell));
    json.key("distance").value(margin.distance).key("closes");
    write_names(json, solved.contacts, margin.closing);
    json.key("opens");
    write_names(json, solved.contacts, margin.opening);
    json.end_object();
  }
  json.end_array().end_object();
}

void write_exact_corners(JsonWriter& json, const convex::atlas::ParameterPolygon& polygon) {
  json.begin_array();
  for (const convex::atlas::ParameterPoint& corner : polygon.corners) {
    json.begin_array();
    for (const convex::Fraction& entry : corner) json.value(text(entry));
    json.end_array();
  }
  json.end_array();
}

void write_map(JsonWriter& json, const SolvedAtlas& solved) {
  const AtlasMap& map = *solved.map;
  json.begin_object().key("over").begin_array();
  for (const ForceRange& range : map.over) {
    json.begin_object().key("key").value(range.key);
    json.key("low").value(convex::nearest_double(range.low));
    json.key("high").value(convex::nearest_double(range.high)).end_object();
  }
  json.end_array().key("area").value(map.area()).key("regions").begin_array();
  for (const convex::atlas::PlaneRegion& region : map.regions) {
    json.begin_object().key("cell").value(static_cast<Index>(region.cell)).key("contacts");
    write_names(json, solved.contacts, solved.atlas.cells[region.cell].rows);
    json.key("area").value(convex::nearest_double(region.polygon.area));
    json.key("part").value(convex::nearest_double(region.polygon.area) / map.area());
    json.key("corners").begin_array();
    for (const convex::atlas::ParameterPoint& corner : region.polygon.corners)
      json.numbers(convex::nearest(convex::exact_vector(corner)));
    json.end_array().key("exact").begin_object().key("area").value(text(region.polygon.area)).key("corners");
    write_exact_corners(json, region.polygon);
    json.end_object().end_object();
  }
  json.end_array().key("drop_negative");
  if (const auto rule = map.rule(solved.atlas)) {
    json.begin_object().key("accepted").value(rule->accepted).key("right").value(rule->right);
    json.key("wrong").value(rule->wrong).end_object();
  } else {
    json.null();
  }
  json.end_object();
}

void write_rule(JsonWriter& json, const convex::atlas::RuleVerdict& rule) {
  json.begin_object();
  const auto one = [&](const char* key, const convex::atlas::Probability& p) {
    json.key(key).begin_object().key("probability").value(p.value);
    json.key("error_bound").value(p.error).end_object();
  };
  one("accepted", rule.accepted);
  one("right", rule.right);
  one("wrong", rule.wrong);
  json.end_object();
}

/// Farkas weights by name, and in fractions.
void write_culprits(JsonWriter& json, const SolvedAtlas& solved) {
  json.key("farkas")
      .numbers(solved.contacts, solved.rounded_farkas)
      .key("exact")
      .begin_object()
      .key("farkas")
      .begin_object();
  for (std::size_t a = 0; a < solved.farkas.size(); ++a)
    json.key(solved.contacts[a]).value(solved.farkas[a].text());
  json.end_object().end_object();
}

const char* status(const SolvedAtlas& solved) {
  if (solved.atlas.cells.empty()) return "infeasible";
  return solved.is_accurate() ? "solved" : "inaccurate";
}

}  // namespace

std::string atlas_json(const SolvedAtlas& solved) {
  const convex::atlas::Atlas& atlas = solved.atlas;
  JsonWriter json;
  json.begin_object().key("file").value(solved.file).key("kind").value("atlas");
  json.key("status").value(status(solved));
  json.key("numbers").value(solved.as_written ? "as written" : "doubles");
  json.key("contacts").begin_array();
  for (const std::string& name : solved.contacts) json.value(name);
  json.end_array();
  if (atlas.cells.empty()) write_culprits(json, solved);
  json.key("dimension").value(static_cast<Index>(atlas.space.rank));
  json.key("complete").value(atlas.is_complete());
  json.key("conical");
  if (atlas.space.cone.n > 0)
    json.value(atlas.is_conical);
  else
    json.null();
  json.key("cells").begin_array();
  for (std::size_t c = 0; c < atlas.cells.size(); ++c) write_cell(json, solved, c);
  json.end_array().key("walls").begin_array();
  for (const Wall& wall : atlas.walls) write_wall(json, solved, wall);
  json.end_array().key("here");
  write_here(json, solved);
  if (!solved.probabilities.empty()) {
    const convex::atlas::Probability sum = solved.sum();
    json.key("distribution").value(solved.distribution);
    json.key("probability_sum").value(sum.value).key("error_sum").value(sum.error);
    json.key("drop_negative");
    if (solved.rule)
      write_rule(json, *solved.rule);
    else
      json.null();
  }
  if (solved.map) {
    json.key("map");
    write_map(json, solved);
  }
  json.end_object();
  return json.text();
}

}  // namespace cli::inline reports
