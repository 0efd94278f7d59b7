#include "cli/report/singular_report.hpp"

#include <fmt/format.h>

#include <limits>

#include "cli/json_writer.hpp"
#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"
#include "mechanics/angles_in_degrees.hpp"
#include "mechanics/branch_edges.hpp"
#include "mechanics/near_contact.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using mechanics::Warning;

const char* name(Warning::Kind kind) {
  switch (kind) {
    case Warning::Kind::near_contact:
      return "near-contact";
    case Warning::Kind::singular:
      return "singular";
    case Warning::Kind::undecided:
      return "undecided";
  }
  return "";
}

std::vector<Index> touching(const SolvedScene& solved) {
  std::vector<Index> found;
  for (std::size_t a = 0; a < solved.states.size(); ++a)
    if (solved.states[a] == ConstraintState::touches) found.push_back(static_cast<Index>(a));
  return found;
}

std::string names(const SolvedScene& solved, const std::vector<Index>& constraints) {
  std::vector<std::string> chosen;
  for (const Index a : constraints) chosen.push_back(solved.scene.constraints[static_cast<std::size_t>(a)]);
  return listed(chosen);
}

/// The multiplier of an added row, or its weight in a contradiction; none without an answer.
std::optional<double> multiplier(const SolvedScene& solved, std::size_t added) {
  const auto row = static_cast<Index>(solved.scene.contacts.size() + added);
  const convex::Vector& all =
      solved.infeasible() ? solved.solution.primal.farkas : solved.solution.multipliers.least_norm;
  return row < all.size() ? std::optional(all[row]) : std::nullopt;
}

}  // namespace

void add_contact_warnings(SolvedScene& solved) {
  std::vector<Warning>& found = solved.warnings;
  const Scene& scene = solved.scene;
  if (!scene.system || !solved.has_answer()) return;
  if (auto near = mechanics::near_contacts(*scene.system, scene.state, {scene.contacts, *scene.rates},
                                           solved.solution.primal.q))
    found.push_back(std::move(*near));
  if (scene.written)
    if (auto edges = mechanics::branch_edges(*scene.system, scene.state, scene.written->radii)) {
      found.push_back(std::move(*edges));
      solved.on_edge = true;
    }
  if (const std::vector<Index> only_touch = touching(solved); !only_touch.empty())
    found.push_back({Warning::Kind::undecided, only_touch,
                     names(solved, only_touch) +
                         ": neither presses nor opens to second order, multiplier and d²f/dt² are 0; higher "
                         "derivatives decide whether contact lasts, so look a moment later"});
}

void write_warnings(JsonWriter& json, const SolvedScene& solved) {
  json.key("warnings").begin_array();
  for (const Warning& warning : solved.warnings) {
    json.begin_object().key("kind").value(name(warning.kind)).key("constraints").begin_array();
    for (const Index a : warning.constraints)
      json.value(solved.scene.constraints[static_cast<std::size_t>(a)]);
    json.end_array().key("message").value(warning.message).end_object();
  }
  json.end_array();
}

namespace {

void write_added_row(JsonWriter& json, const Scene& scene, std::size_t k) {
  json.key("weights").begin_object();
  for (const auto& [constraint, weight] : scene.added[k].weights)
    json.key(scene.constraints[static_cast<std::size_t>(constraint)]).value(weight);
  json.end_object().key("row").numbers(scene.coordinates, scene.added[k].row);
  json.key("rhs").value(scene.added[k].rhs);
}

}  // namespace

void write_added_rows(JsonWriter& json, const SolvedScene& solved) {
  const Scene& scene = solved.scene;
  if (scene.added.empty()) return;
  json.key("added_rows").begin_array();
  for (std::size_t k = 0; k < scene.added.size(); ++k) {
    json.begin_object();
    write_added_row(json, scene, k);
    json.key("multiplier");
    if (const auto lambda = multiplier(solved, k))
      json.value(*lambda).end_object();
    else
      json.null().end_object();
  }
  json.end_array();
}

void write_added_rows(JsonWriter& json, const Scene& scene) {
  if (scene.added.empty()) return;
  json.key("added_rows").begin_array();
  for (std::size_t k = 0; k < scene.added.size(); ++k) {
    json.begin_object();
    write_added_row(json, scene, k);
    json.end_object();
  }
  json.end_array();
}

std::string added_row_text(const Scene& scene, std::size_t k) {
  const mechanics::AddedRow& added = scene.added[k];
  std::vector<std::string> weighed, terms;
  for (const auto& [constraint, weight] : added.weights)
    weighed.push_back(fmt::format("{} of {}", number_text(weight),
                                  scene.constraints[static_cast<std::size_t>(constraint)]));
  for (Index i = 0; i < added.row.size(); ++i)
    if (added.row[i] != 0)
      terms.push_back(
          fmt::format("{} {}''", number_text(added.row[i]), scene.coordinates[static_cast<std::size_t>(i)]));
  const std::string equation = fmt::format("the sum of {} is {}", listed(terms), number_text(added.rhs));
  return added.is_linear_form
             ? fmt::format("In place of {}, which says the same here (theory.md, B.8), row {}: {}",
                           scene.constraints[static_cast<std::size_t>(added.main)], k + 1, equation)
             : fmt::format(
                   "Second derivatives do not tell the motion here (theory.md, B.8). Added row {}, "
                   "from the third ones ({}): {}",
                   k + 1, listed(weighed), equation);
}

std::string added_rows_text(const SolvedScene& solved) {
  std::string text;
  for (std::size_t k = 0; k < solved.scene.added.size(); ++k)
    text +=
        fmt::format("{}; multiplier {}.\n", added_row_text(solved.scene, k),
                    number_text(multiplier(solved, k).value_or(std::numeric_limits<double>::quiet_NaN())));
  return text;
}

std::string touching_text(const SolvedScene& solved) {
  const std::vector<Index> only_touch = touching(solved);
  if (only_touch.empty() || !solved.scene.system) return "";
  return names(solved, only_touch) +
         (only_touch.size() == 1 ? ": neither presses nor opens to second order; higher derivatives decide.\n"
                                 : ": neither press nor open to second order; higher derivatives decide.\n");
}

std::vector<std::string> warning_lines(const std::vector<Warning>& warnings) {
  std::vector<std::string> lines;
  for (const Warning& warning : warnings)
    lines.push_back(std::string(name(warning.kind)) + ": " + warning.message);
  return lines;
}

std::vector<std::string> warning_lines(const SolvedScene& solved) {
  std::vector<std::string> lines = warning_lines(solved.warnings);
  if (solved.scene.system)
    for (std::string& angle : mechanics::angles_in_degrees(*solved.scene.system, solved.scene.state))
      lines.push_back(std::move(angle));
  return lines;
}

}  // namespace cli::inline reports
