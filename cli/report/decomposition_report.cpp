#include "cli/report/decomposition_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "cli/report/json_writer.hpp"
#include "cli/report/text_table.hpp"
#include "convex/catalogue/catalogue.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::InvalidInput;

/// The only method that applies: a function knows how its prox is found.
constexpr const char* own_method = "auto";

const char* name(convex::ProxRoute route) {
  switch (route) {
    case convex::ProxRoute::closed_form:
      return "closed form";
    case convex::ProxRoute::active_set:
      return "active set";
    case convex::ProxRoute::iterative:
      return "iterative";
  }
  return "";
}

/// "active set: on the epigraph"; the route alone where the method says no more; and whether the prox of the
/// conjugate led to it.
std::string how(const convex::Prox& prox) {
  const std::string route = name(prox.route);
  const std::string identity = prox.by_conjugate ? ", from the conjugate by Moreau's identity" : "";
  if (prox.method.empty() || prox.method == route) return route + identity;
  return (prox.method.starts_with(route) ? prox.method : route + ": " + prox.method) + identity;
}

}  // namespace

void require_applicable(const SolveSettings& settings, const AccuracyOptions& options, bool certify) {
  const bool from_file = !options.method && settings.method;
  if (const std::string method = options.method.value_or(settings.method.value_or(own_method));
      method != own_method)
    throw InvalidInput("method \"" + method +
                           "\" does not apply to a decomposition: each function has its own way to its prox; "
                           "leave the method out",
                       from_file ? std::optional(settings.method_place) : std::nullopt);
  if (certify) throw InvalidInput("--certify proves answers to [system] and [projection] only; leave it out");
  if (settings.contact_tolerance || !settings.contact_tolerances.empty())
    throw InvalidInput("solve.contact_tolerance: goes with [system] only; take it out",
                       settings.contact_tolerance_place);
}

SplitPoint split_point(const DecompositionProblem& problem, const SolveSettings& settings,
                       const AccuracyOptions& options) {
  constexpr double default_tolerance = 1e-9;
  const double tolerance = options.tolerance.value_or(settings.tolerance.value_or(default_tolerance));
  const convex::Function f = convex::make_function(problem.f, {problem.W});
  const auto start = std::chrono::steady_clock::now();
  SplitPoint made{problem, convex::decompose(f, problem.z, problem.W, tolerance), 0};
  made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return made;
}

void write_split(JsonWriter& json, const SplitPoint& solved, const std::string& file) {
  const convex::Decomposition& split = solved.split;
  if (!file.empty()) json.key("file").value(file);
  json.key("kind").value("decomposition").key("status").value(name(split.status));
  json.key("x").numbers(split.x.x).key("y").numbers(split.y.x);
  json.key("f_x").value(split.f_x).key("g_y").value(split.g_y).key("inner").value(split.inner);
  json.key("fenchel_gap").value(split.fenchel_gap).key("residual").value(split.residual);
  json.key("route").begin_object().key("x").value(how(split.x)).key("y").value(how(split.y)).end_object();
  json.key("certificate").begin_object().key("level").value("estimate");
  json.key("error_bound").value(split.error_bound).end_object();
  json.key("seconds").value(solved.seconds);
}

std::string split_json(const SplitPoint& solved, const std::string& file) {
  JsonWriter json;
  json.begin_object();
  write_split(json, solved, file);
  return json.end_object().text();
}

std::string split_text(const SplitPoint& solved) {
  const convex::Decomposition& split = solved.split;
  const convex::Vector& z = solved.problem.z;
  TextTable table({"", "z", "x = prox_f z", "y = prox_g z"});
  for (Index i = 0; i < std::min(z.size(), most_rows); ++i)
    table.add(
        {fmt::format("[{}]", i), number_text(z[i]), number_text(split.x.x[i]), number_text(split.y.x[i])});
  std::string text = table.text();
  if (z.size() > most_rows)
    text += fmt::format("  … and {} more entries; --json gives all\n", z.size() - most_rows);
  text += fmt::format("\nf(x) = {}, g(y) = {}, (x|y) = {}: f(x) + g(y) - (x|y) = {:.1e}\n",
                      number_text(split.f_x), number_text(split.g_y), number_text(split.inner),
                      split.fenchel_gap);
  text += fmt::format("x: {}. y: {}. Their sum misses z by {:.1e}.\n", how(split.x), how(split.y),
                      split.residual);
  text += fmt::format(
      "{}: error of x and of y at most about {:.1e}.\n",
      split.status == convex::Status::solved ? "Solved" : "NOT solved to the accuracy that was asked for",
      split.error_bound);
  return text;
}

}  // namespace cli
