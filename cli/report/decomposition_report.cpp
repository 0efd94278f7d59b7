#include "cli/report/decomposition_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "cli/json_writer.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::InvalidInput;

/// A function knows how its prox is found; fractions are the other way.
constexpr std::string_view own_method = "auto", in_fractions = "exact";

std::string chosen_method(const SolveSettings& settings, const AccuracyOptions& options) {
  return options.method.value_or(settings.method.value_or(std::string(own_method)));
}

void write(JsonWriter& json, const char* key, const convex::ProvedInterval& interval) {
  json.key(key).begin_array().value(interval.low).value(interval.high).end_array();
}

void write_fractions(JsonWriter& json, const char* key, const convex::Fractions& x) {
  json.key(key).begin_array();
  for (const convex::Fraction& entry : x) json.value(convex::text(entry));
  json.end_array();
}

void write_certificate(JsonWriter& json, const SplitPoint& solved) {
  json.key("certificate").begin_object();
  if (!solved.proof) {
    json.key("level").value("estimate").key("error_bound").value(solved.split.error_bound).end_object();
    return;
  }
  const convex::ProvedSplit& proof = *solved.proof;
  json.key("level").value(name(proof.level));
  const bool proved = proof.level != convex::ProofLevel::none;
  json.key("error_bound").value(proved ? proof.error_bound() : solved.split.error_bound);
  if (!proved) {
    json.key("why").value(proof.why_none).end_object();
    return;
  }
  json.key("x").value(proof.x_bound).key("y").value(proof.y_bound);
  write(json, "f_x", proof.f_x);
  write(json, "g_y", proof.g_y);
  write(json, "inner", proof.inner);
  json.key("sum").value(proof.sum_miss).end_object();
}

void write_exact(JsonWriter& json, const convex::ExactSplit& exact) {
  json.key("exact").begin_object();
  write_fractions(json, "x", exact.x);
  write_fractions(json, "y", exact.y);
  json.key("f_x").value(convex::text(exact.f_x)).key("g_y").value(convex::text(exact.g_y));
  json.key("inner").value(convex::text(exact.inner)).end_object();
}

std::string proof_text(const SplitPoint& solved) {
  const convex::ProvedSplit& proof = *solved.proof;
  if (proof.level == convex::ProofLevel::none) return "NOT proved: " + proof.why_none + ".\n";
  std::string text = fmt::format(
      "Proved{}: the error of x is at most {}, that of y at most {}; each was proved by itself, and "
      "their sum misses z by {} at most.\n",
      proof.level == convex::ProofLevel::exact ? " in rational arithmetic" : "", error_text(proof.x_bound),
      error_text(proof.y_bound), error_text(proof.sum_miss));
  const auto line = [&](const char* what, const convex::ProvedInterval& interval) {
    text += interval.low == interval.high
                ? fmt::format("{} = {}\n", what, number_text(interval.low))
                : fmt::format("{} lies in [{:.17g}, {:.17g}]\n", what, interval.low, interval.high);
  };
  line("f(x*)", proof.f_x);
  line("g(y*)", proof.g_y);
  line("(x*|y*)", proof.inner);
  return text;
}

/// Fractions longer than this are left to --json.
constexpr std::size_t longest_fraction = 60;

std::string fraction_text(const convex::Fraction& a) {
  std::string text = convex::text(a);
  return text.size() > longest_fraction ? std::to_string(text.size()) + " digits" : text;
}

std::string exact_text(const convex::ExactSplit& exact) {
  TextTable table({"exact", "x", "y"});
  for (std::size_t i = 0; i < std::min(exact.x.size(), static_cast<std::size_t>(most_rows)); ++i)
    table.add({fmt::format("[{}]", i), fraction_text(exact.x[i]), fraction_text(exact.y[i])});
  return "\n" + table.text() +
         fmt::format("f(x) = {}, g(y) = {}, (x|y) = {}; x + y = z without rounding.\n",
                     fraction_text(exact.f_x), fraction_text(exact.g_y), fraction_text(exact.inner));
}

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

void require_applicable(const SolveSettings& settings, const AccuracyOptions& options) {
  const bool from_file = !options.method && settings.method;
  if (const std::string method = chosen_method(settings, options);
      method != own_method && method != in_fractions)
    throw InvalidInput("method \"" + method +
                           "\" does not apply to a decomposition: each function has its own way to its prox; "
                           "leave the method out, or ask for exact",
                       from_file ? std::optional(settings.method_place) : std::nullopt);
  if (settings.contact_tolerance || !settings.contact_tolerances.empty())
    throw InvalidInput("solve.contact_tolerance: goes with [system] only; take it out",
                       settings.contact_tolerance_place);
}

Exit SplitPoint::exit() const {
  const bool unproved = proof && proof->level == convex::ProofLevel::none;
  return unproved ? std::max(exit_code(split.status), Exit::inaccurate) : exit_code(split.status);
}

SplitPoint split_point(const DecompositionProblem& problem, const SolveSettings& settings,
                       const AccuracyOptions& options, bool certify) {
  constexpr double default_tolerance = 1e-9;
  const double tolerance = options.tolerance.value_or(settings.tolerance.value_or(default_tolerance));
  const bool exactly = chosen_method(settings, options) == in_fractions;
  const convex::Function f = convex::make_function(problem.f, {problem.W});
  const auto start = std::chrono::steady_clock::now();
  SplitPoint made{problem, {}, 0};
  if (exactly || certify) {
    const convex::SplitQuestion question = problem.exact();
    if (exactly) {
      made.exact = convex::exact_split(question);
      made.split = convex::rounded(*made.exact, question);
      made.proof = convex::proof_of(*made.exact, made.split, question);
    } else {
      made.split = convex::decompose(f, problem.z, problem.W, tolerance);
      made.proof = convex::prove(question, made.split);
    }
    if (made.proof->level != convex::ProofLevel::none) {
      // ||z||_W of fractions, which does not overflow where the squares of doubles do; ||x|| enters where the
      // doubles have it.
      const convex::ProvedMetric W(question.W);
      const double of_x = problem.W.norm(made.split.x.x);
      const double size = std::max({1.0, W.norm_above(question.z), std::isfinite(of_x) ? of_x : 0.0});
      made.split.error_bound = made.proof->error_bound();
      made.split.status =
          made.split.error_bound <= tolerance * size ? convex::Status::solved : convex::Status::inaccurate;
    }
  } else {
    made.split = convex::decompose(f, problem.z, problem.W, tolerance);
  }
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
  write_certificate(json, solved);
  if (solved.exact) write_exact(json, *solved.exact);
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
  // x + y = z: what is rounding beside z and within the bound is 0.
  const auto told = [&](double part, double whole) {
    return number_text(std::abs(part) <= split.error_bound ? without_rounding(part, std::abs(whole)) : part);
  };
  for (Index i = 0; i < std::min(z.size(), most_rows); ++i)
    table.add(
        {fmt::format("[{}]", i), number_text(z[i]), told(split.x.x[i], z[i]), told(split.y.x[i], z[i])});
  std::string text = table.text();
  if (z.size() > most_rows)
    text += fmt::format("  … and {} more entries; --json gives all\n", z.size() - most_rows);
  text +=
      fmt::format("\nf(x) = {}, g(y) = {}, (x|y) = {}: f(x) + g(y) - (x|y) = {}\n", number_text(split.f_x),
                  number_text(split.g_y), number_text(split.inner), error_text(split.fenchel_gap));
  text += fmt::format("x: {}. y: {}. Their sum misses z by {}.\n", how(split.x), how(split.y),
                      error_text(split.residual));
  if (solved.exact) text += exact_text(*solved.exact);
  if (solved.proof) text += proof_text(solved);
  const bool proved = solved.proof && solved.proof->level != convex::ProofLevel::none;
  if (proved && split.status == convex::Status::solved) return text;
  text += fmt::format(
      "{}: error of x and of y at most about {}.\n",
      split.status == convex::Status::solved ? "Solved" : "NOT solved to the accuracy that was asked for",
      error_text(split.error_bound));
  return text;
}

}  // namespace cli::inline reports
