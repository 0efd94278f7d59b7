#include "cli/report/cone_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "cli/json_writer.hpp"
#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"
#include "convex/cones/cone_operations.hpp"

namespace cli::inline reports {
namespace {

using convex::ConeFace;
using convex::Index;
using convex::IntegerRows;
using convex::PolyhedralCone;

void write_rows(JsonWriter& json, const char* key, const IntegerRows& rows, Index n) {
  constexpr double largest_integer = 0x1p53;
  const convex::RowMatrix M = convex::nearest_directions(rows, n);
  json.key(key).begin_array();
  for (Index i = 0; i < M.rows(); ++i) {
    json.begin_array();
    for (double entry : M.row(i))
      if (std::abs(entry) <= largest_integer && entry == std::trunc(entry))
        json.value(static_cast<Index>(entry));
      else
        json.value(entry);
    json.end_array();
  }
  json.end_array();
}

void write_descriptions(JsonWriter& json, const PolyhedralCone& K) {
  write_rows(json, "generators", K.generators, K.n);
  write_rows(json, "lines", K.lines, K.n);
  write_rows(json, "halfspaces", K.halfspaces, K.n);
  write_rows(json, "equations", K.equations, K.n);
}

void write_face(JsonWriter& json, const char* key, const ConeFace& face) {
  json.key(key).begin_object().key("dimension").value(face.dimension).key("generators").begin_array();
  for (Index k : face.generators) json.value(k);
  json.end_array().key("halfspaces").begin_array();
  for (Index h : face.halfspaces) json.value(h);
  json.end_array().end_object();
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string rows_text(const char* what, const char* mark, const IntegerRows& rows, Index n) {
  if (rows.empty()) return "";
  // Integers that are too long to read are shown by their ratios.
  constexpr double longest = 1e6;
  convex::RowMatrix M = convex::nearest_directions(rows, n);
  std::optional<TextTable> table;
  for (Index i = 0; i < std::min(M.rows(), most_rows); ++i) {
    if (const double largest = M.row(i).cwiseAbs().maxCoeff(); largest >= longest) M.row(i) /= largest;
    std::vector<std::string> cells{fmt::format("  {}[{}]", mark, i)};
    for (double entry : M.row(i)) cells.push_back(number_text(entry));
    if (table)
      table->add(std::move(cells));
    else
      table.emplace(std::move(cells));
  }
  return fmt::format("  {}\n{}", what, table->text()) +
         (M.rows() > most_rows ? fmt::format("    … and {} more; --json gives all\n", M.rows() - most_rows)
                               : "");
}

std::string descriptions_text(const PolyhedralCone& K) {
  if (K.is_zero()) return "  only 0\n";
  if (K.is_full()) return "  the whole space\n";
  return rows_text("generators", "g", K.generators, K.n) + rows_text("lines (both ways)", "b", K.lines, K.n) +
         rows_text("half-spaces a·x <= 0", "a", K.halfspaces, K.n) +
         rows_text("equations e·x = 0", "e", K.equations, K.n);
}

std::string face_text(const PolyhedralCone& K, const ConeFace& face) {
  if (face.dimension == 0) return "is 0";
  if (face.dimension == K.dimension()) return "lies inside it";
  std::vector<std::string> spanning;
  for (Index k : face.generators) spanning.push_back(fmt::format("g[{}]", k));
  if (!K.lines.empty()) spanning.emplace_back("the lines");
  return fmt::format("lies on the face of dimension {} that {} span{}", face.dimension, listed(spanning),
                     spanning.size() == 1 && K.lines.empty() ? "s" : "");
}

std::string split_text(const SolvedCone& solved) {
  const convex::Vector z = convex::nearest(*solved.problem.z), x = convex::nearest(solved.split->x),
                       y = convex::nearest(solved.split->y);
  TextTable table({"", "z", "x in the cone", "y in the polar"});
  for (Index i = 0; i < std::min(z.size(), most_rows); ++i)
    table.add({fmt::format("[{}]", i), number_text(z[i]), number_text(x[i]), number_text(y[i])});
  std::string text = "\n" + table.text();
  text += fmt::format("\nx {}; y, found from the polar's own generators, {}.\n",
                      face_text(solved.cone, solved.split->face),
                      face_text(solved.polar, solved.split->polar_face));
  return text + "In fractions z = x + y and (x|y) = 0 hold exactly; what is printed is rounded once.\n";
}

}  // namespace

void require_cone_settings(const SolveSettings& settings, const AccuracyOptions& options) {
  const std::string method = options.method.value_or(settings.method.value_or("auto"));
  if (method != "auto" && method != "exact")
    throw convex::InvalidInput("method \"" + method +
                                   "\" does not apply to a cone, which is computed in exact arithmetic; "
                                   "leave the method out",
                               options.method ? std::nullopt : std::optional(settings.method_place));
  if (settings.contact_tolerance || !settings.contact_tolerances.empty())
    throw convex::InvalidInput("solve.contact_tolerance: goes with [system] only; take it out",
                               settings.contact_tolerance_place);
}

SolvedCone solve_cone(const ConeProblem& problem) {
  const auto start = std::chrono::steady_clock::now();
  SolvedCone solved{problem,
                    problem.by_halfspaces ? convex::halfspace_cone(problem.rows, problem.two_way, problem.n)
                                          : convex::generated_cone(problem.rows, problem.two_way, problem.n),
                    {},
                    {},
                    0};
  solved.polar = convex::polar(solved.cone, problem.W);
  if (problem.z) solved.split = convex::split(solved.cone, solved.polar, *problem.z, problem.W);
  solved.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solved;
}

void write_cone(JsonWriter& json, const SolvedCone& solved, const std::string& file) {
  json.key("file").value(file).key("kind").value("cone").key("status").value("solved");
  write_descriptions(json, solved.cone);
  json.key("polar").begin_object();
  write_descriptions(json, solved.polar);
  json.end_object();
  json.key("dimension").value(solved.cone.dimension()).key("pointed").value(solved.cone.is_pointed());
  if (solved.split) {
    json.key("x").numbers(convex::nearest(solved.split->x));
    json.key("y").numbers(convex::nearest(solved.split->y));
    json.key("inner").value(convex::nearest_double(solved.split->inner));
    json.key("residual").value(solved.split->residual);
    write_face(json, "face", solved.split->face);
    write_face(json, "polar_face", solved.split->polar_face);
  }
  json.key("seconds").value(solved.seconds);
}

std::string cone_json(const SolvedCone& solved, const std::string& file) {
  JsonWriter json;
  json.begin_object();
  write_cone(json, solved, file);
  return json.end_object().text();
}

std::string cone_text(const SolvedCone& solved) {
  const PolyhedralCone& K = solved.cone;
  std::string text =
      fmt::format("A cone of dimension {} in {} dimensions, {}: {}, {}, {}, {}.\n\n", K.dimension(), K.n,
                  K.is_pointed() ? "pointed" : "with a lineality space",
                  counted(K.generators.size(), "generator"), counted(K.lines.size(), "line"),
                  counted(K.halfspaces.size(), "half-space"), counted(K.equations.size(), "equation"));
  text += descriptions_text(K);
  text += "\nIts polar in the product of the metric:\n\n" + descriptions_text(solved.polar);
  return solved.split ? text + split_text(solved) : text;
}

}  // namespace cli::inline reports
