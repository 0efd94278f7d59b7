#include "cli/report/subdifferential_report.hpp"

#include <fmt/format.h>

#include "cli/json_writer.hpp"
#include "cli/report/text_table.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace cli::inline reports {
namespace {

using convex::ExactHalfspace;
using convex::ExactPolyhedron;
using convex::Fraction;
using convex::Fractions;
using convex::IntegerRows;
using convex::IntegerVector;

Fractions as_fractions(const IntegerVector& v) {
  Fractions made;
  for (const convex::Integer& entry : v) made.push_back(Fraction{entry});
  return made;
}

void write_row(JsonWriter& json, const Fractions& x) {
  json.begin_array();
  for (const Fraction& entry : x) json.value(nearest_double(entry));
  json.end_array();
}

void write_directions(JsonWriter& json, const char* key, const IntegerRows& rows) {
  json.key(key).begin_array();
  for (const IntegerVector& row : rows) write_row(json, as_fractions(row));
  json.end_array();
}

void write_halfspaces(JsonWriter& json, const char* key, const std::vector<ExactHalfspace>& rows) {
  json.key(key).begin_array();
  for (const ExactHalfspace& row : rows) {
    json.begin_object().key("normal");
    write_row(json, as_fractions(row.normal));
    json.key("limit").value(nearest_double(Fraction{row.limit})).end_object();
  }
  json.end_array();
}

void write_polyhedron(JsonWriter& json, const ExactPolyhedron& P) {
  json.begin_object().key("vertices").begin_array();
  for (const Fractions& vertex : P.vertices) write_row(json, vertex);
  json.end_array();
  write_directions(json, "rays", P.rays);
  write_directions(json, "lines", P.lines);
  write_halfspaces(json, "halfspaces", P.halfspaces);
  write_halfspaces(json, "equations", P.equations);
  json.end_object();
}

void write_cone(JsonWriter& json, const char* key, const convex::PolyhedralCone& K) {
  json.key(key).begin_object();
  write_directions(json, "generators", K.generators);
  write_directions(json, "lines", K.lines);
  write_directions(json, "halfspaces", K.halfspaces);
  write_directions(json, "equations", K.equations);
  json.end_object();
}

std::string row_text(const Fractions& x) {
  std::string text;
  for (const Fraction& entry : x) text += (text.empty() ? "" : ", ") + number_text(nearest_double(entry));
  return "(" + text + ")";
}

template <class Rows, class Text>
std::string lines_of(const char* what, const Rows& rows, const Text& text_of) {
  std::string text;
  for (const auto& row : rows) text += fmt::format("{}{}", text.empty() ? "" : ", ", text_of(row));
  return rows.empty() ? "" : fmt::format("  {:<12}{}\n", what, text);
}

std::string directions_text(const char* what, const IntegerRows& rows) {
  return lines_of(what, rows, [](const IntegerVector& row) { return row_text(as_fractions(row)); });
}

std::string halfspaces_text(const char* what, const std::vector<ExactHalfspace>& rows, const char* relation) {
  // Long integers are those of rounded numbers: they are told with a largest entry of 1.
  const convex::Fraction most_plain{10000000000};
  return lines_of(what, rows, [&](const ExactHalfspace& row) {
    convex::Fractions normal = as_fractions(row.normal);
    convex::Fraction limit{row.limit}, largest;
    for (const convex::Fraction& entry : normal) {
      const convex::Fraction size = sign(entry) < 0 ? -entry : entry;
      if (largest < size) largest = size;
    }
    if (most_plain < largest) {
      for (convex::Fraction& entry : normal) entry = entry / largest;
      limit = limit / largest;
    }
    return row_text(normal) + ".v " + relation + " " + number_text(nearest_double(limit));
  });
}

std::string polyhedron_text(const ExactPolyhedron& P) {
  return lines_of("vertices", P.vertices, row_text) + directions_text("rays", P.rays) +
         directions_text("lines", P.lines) + halfspaces_text("half-spaces", P.halfspaces, "<=") +
         halfspaces_text("equations", P.equations, "=");
}

std::string cone_lines(const char* what, const convex::PolyhedralCone& K) {
  if (K.is_zero()) return fmt::format("{}: 0 alone\n", what);
  return fmt::format("{}\n", what) + directions_text("generators", K.generators) +
         directions_text("lines", K.lines);
}

}  // namespace

std::string subdifferential_json(const ToldSubdifferential& told) {
  const convex::Subdifferential& at = told.at;
  JsonWriter json;
  json.begin_object().key("kind").value("subdifferential").key("status").value("solved");
  json.key("f").value(to_text(told.f)).key("at");
  write_row(json, told.x);
  json.key("empty").value(at.is_empty()).key("single").value(at.is_single());
  json.key("exact").value(at.is_exact).key("set");
  if (at.set)
    json.value(to_text(at.set->call));
  else
    json.null();
  json.key("polyhedron");
  if (at.polyhedron && !at.is_empty())
    write_polyhedron(json, *at.polyhedron);
  else
    json.null();
  if (at.is_empty()) json.key("why").value(told.why_empty);
  if (told.least) json.key("least").numbers(*told.least).key("least_norm").value(told.least_norm);
  if (told.contains) json.key("contains").value(*told.contains);
  if (told.along) json.key("along").value(*told.along);
  if (told.tangent) write_cone(json, "tangent_cone", *told.tangent);
  if (told.critical) write_cone(json, "critical_cone", *told.critical);
  return json.end_object().text() + "\n";
}

std::string subdifferential_text(const ToldSubdifferential& told) {
  const convex::Subdifferential& at = told.at;
  std::string text = fmt::format("f = {} at {}\n", to_text(told.f), row_text(told.x));
  if (at.is_empty()) return text + "The subdifferential is empty: " + told.why_empty + ".\n";
  if (at.is_single())
    text += fmt::format("One subgradient{}: {}\n", at.is_exact ? "" : ", rounded",
                        row_text(at.polyhedron->vertices.front()));
  else
    text += fmt::format("The subdifferential is {}\n", to_text(at.set->call));
  if (at.polyhedron && !at.is_single()) text += polyhedron_text(*at.polyhedron);
  if (told.least && !at.is_single())
    text += fmt::format("of least norm: {}, norm {}\n", row_text(convex::fractions(*told.least)),
                        number_text(told.least_norm));
  if (told.contains) text += fmt::format("The covector is {}a subgradient.\n", *told.contains ? "" : "not ");
  if (told.along) text += fmt::format("directional derivative: {}\n", number_text(*told.along));
  if (told.tangent) text += cone_lines("tangent cone", *told.tangent);
  if (told.critical) text += cone_lines("critical cone", *told.critical);
  return text;
}

}  // namespace cli::inline reports
