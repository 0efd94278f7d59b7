#include "cli/report/map_report.hpp"

#include <fmt/format.h>

#include "cli/json_writer.hpp"
#include "cli/report/symbolic_report.hpp"
#include "cli/report/text_table.hpp"
#include "convex/counted.hpp"
#include "convex/symbolic/function.hpp"

namespace cli::inline reports {
namespace {

using convex::ExactVector;
using convex::Index;
using convex::MapCounterexample;
using convex::MapLaw;

std::string point_text(const ExactVector& x) {
  std::string text;
  for (std::size_t i = 0; i < x.numerators.size(); ++i)
    text += (i > 0 ? ", " : "") + convex::text(entry(x, i));
  return x.numerators.size() == 1 ? text : "(" + text + ")";
}

/// As a fraction where that is short, else in digits.
std::string image_text(const convex::MapImage& image) {
  constexpr std::size_t longest = 60;
  const std::string exact = point_text(image.value);
  if (image.radius == 0 && exact.size() <= longest) return exact;
  std::string text;
  const convex::Vector rounded = convex::nearest(image.value);
  for (Index i = 0; i < rounded.size(); ++i) text += (i > 0 ? ", " : "") + fmt::format("{:.17g}", rounded[i]);
  if (rounded.size() > 1) text = "(" + text + ")";
  return image.radius == 0 ? text : text + fmt::format(" +- {:.0e}", image.radius);
}

std::string fraction_text(const convex::Fraction& value) {
  constexpr std::size_t longest = 40;
  const std::string exact = convex::text(value);
  return exact.size() <= longest ? exact : convex::decimal_text(value, 12);
}

/// "S[1][2] = 1/100, S[2][1] = -1/100".
std::string unequal_text(const MapCounterexample& found) {
  const convex::UnequalEntries& S = *found.entries;
  std::string text = fmt::format("  x = {}\n", point_text(found.points.front()));
  text += fmt::format("  S = W T'(x):  S[{}][{}] = {}, S[{}][{}] = {}\n", S.i + 1, S.j + 1,
                      fraction_text(S.S_ij), S.j + 1, S.i + 1, fraction_text(S.S_ji));
  text += fmt::format("  their difference is {}", fraction_text(found.excess));
  return text + (S.radius > 0 ? fmt::format(" +- {:.0e} > 0\n", S.radius) : " > 0\n");
}

std::string counterexample_text(const MapCounterexample& found) {
  if (found.law == MapLaw::symmetric)
    return "Refuted: its derivative times the metric is not symmetric, so it is the prox of no function in "
           "this "
           "metric.\n" +
           unequal_text(found);
  const bool is_pair = found.law == MapLaw::nonexpansive;
  std::string text =
      is_pair ? "Refuted: it is not nonexpansive, so it is the prox of no function in this metric.\n"
              : fmt::format("Refuted: it is not {}, so it is the prox of no function in this metric.\n",
                            found.points.size() == 2
                                ? std::string("monotone")
                                : fmt::format("cyclically monotone on {} points", found.points.size()));
  constexpr std::size_t most_told = 12;
  for (std::size_t k = 0; k < std::min(most_told, found.points.size()); ++k)
    text += fmt::format("  x{} = {},  T x{} = {}\n", k, point_text(found.points[k]), k,
                        image_text(found.images[k]));
  if (found.points.size() > most_told) text += "  and so on; --json has all\n";
  return text +
         (is_pair ? "  ||T x0 - T x1||² - ||x0 - x1||² = " : "  the sum of (T xi | xi - x(i+1)) is -") +
         fraction_text(found.excess) + (is_pair ? " > 0\n" : " < 0\n");
}

void write_points(JsonWriter& json, const std::vector<ExactVector>& points) {
  json.begin_array();
  for (const ExactVector& point : points) {
    json.begin_array();
    for (std::size_t i = 0; i < point.numerators.size(); ++i) json.value(convex::text(entry(point, i)));
    json.end_array();
  }
  json.end_array();
}

const char* law_name(MapLaw law) {
  if (law == MapLaw::symmetric) return "symmetric";
  return law == MapLaw::nonexpansive ? "nonexpansive" : "cyclically-monotone";
}

}  // namespace

std::string map_json(const JudgedMap& judged) {
  const convex::MapVerdict& verdict = judged.verdict;
  JsonWriter json;
  json.begin_object().key("kind").value("map").key("map").value(judged.source);
  json.key("status").value(judged.is_refuted() ? "refuted" : "not-refuted");
  json.key("points").value(verdict.points).key("undefined").value(verdict.undefined);
  if (!judged.is_table)
    json.key("seen")
        .begin_array()
        .value(convex::nearest_double(judged.seen.first))
        .value(convex::nearest_double(judged.seen.second))
        .end_array();
  json.key("polygons").value(verdict.polygons).key("symmetric_at").value(verdict.symmetric_at);
  json.key("asymmetry").value(verdict.asymmetry);
  json.key("counterexample");
  if (const auto& found = verdict.counterexample) {
    json.begin_object().key("law").value(law_name(found->law)).key("points");
    write_points(json, found->points);
    std::vector<ExactVector> images;
    double radius = 0;
    for (const convex::MapImage& image : found->images) {
      images.push_back(image.value);
      radius = std::max(radius, image.radius);
    }
    json.key("images");
    write_points(json, images);
    json.key("radius").value(radius).key("excess").value(convex::text(found->excess));
    if (const auto& S = found->entries) {
      json.key("entries").begin_object().key("row").value(S->i + 1).key("column").value(S->j + 1);
      json.key("value").value(convex::text(S->S_ij)).key("mirrored").value(convex::text(S->S_ji));
      json.key("radius").value(S->radius).end_object();
    }
    json.end_object();
  } else {
    json.null();
  }
  json.key("f");
  if (judged.function)
    write_cases(json, convex::symbolic::formula(*judged.function));
  else
    json.null();
  return json.end_object().text();
}

std::string map_text(const JudgedMap& judged) {
  const convex::MapVerdict& verdict = judged.verdict;
  if (verdict.counterexample) return counterexample_text(*verdict.counterexample);
  const std::string range = judged.is_table ? ""
                                            : fmt::format("[{}, {}]", fraction_text(judged.seen.first),
                                                          fraction_text(judged.seen.second));
  std::string text =
      fmt::format("Not refuted at {}{}, on cycles through them",
                  convex::counted(verdict.points, "point", "points"), judged.is_table ? "" : " of " + range);
  if (verdict.polygons > 0)
    text += fmt::format(" and on {}", convex::counted(verdict.polygons, "polygon", "polygons"));
  text += ". Sampling can only refute: this is no proof.\n";
  if (verdict.undefined > 0)
    text +=
        fmt::format("At {} the map has no value.\n", convex::counted(verdict.undefined, "point", "points"));
  if (verdict.symmetric_at > 0)
    text += fmt::format("Jacobian times metric: symmetric at {}, by exact derivatives.\n",
                        convex::counted(verdict.symmetric_at, "point", "points"));
  else if (verdict.asymmetry > 0)
    text += fmt::format("Jacobian times metric: symmetric to {}, by differences.\n",
                        error_text(verdict.asymmetry));
  if (judged.function) {
    text += judged.is_table
                ? "Joined by straight lines it is the prox of, up to a constant,\n"
                : "As far as it was seen, on " + range + ", it is the prox of, up to a constant,\n";
    text += cases_text("f(x)", "x", convex::symbolic::formula(*judged.function));
  } else if (!judged.grid.empty()) {
    text += fmt::format("f is known at {} T z, if it is a prox; --data F.csv writes them.\n",
                        convex::counted(judged.grid.size(), "point", "points"));
  }
  return text;
}

std::string potential_table(const JudgedMap& judged) {
  std::string text;
  for (const convex::PotentialPoint& point : judged.grid) {
    if (text.empty()) {
      for (const char* of : {"z", "Tz"})
        for (Index i = 0; i < point.z.size(); ++i) text += fmt::format("{}[{}],", of, i);
      text += "f,error\n";
    }
    for (const convex::Vector* vector : {&point.z, &point.p})
      for (const double entry : *vector) text += fmt::format("{},", entry);
    text += fmt::format("{},{}\n", point.f, point.error);
  }
  return text;
}

}  // namespace cli::inline reports
