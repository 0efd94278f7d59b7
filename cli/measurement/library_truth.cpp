#include "cli/measurement/library_truth.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/json_writer.hpp"
#include "convex/laws/trial.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace cli::inline measurement {
namespace {

using convex::ExactVector;
using convex::Fraction;
using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;

/// Ranges of multipliers in fractions are two linear programs each.
constexpr Index most_ranges_in_fractions = 64;

/// Longer fractions are left to the decimals.
constexpr std::size_t longest_fraction = 60;

double condition_of_rows(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  if (rows.size() < 2) return 1;
  Matrix unit(problem.dimension(), static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const convex::Vector whitened = problem.A.whiten(problem.U.row(rows[k]));
    unit.col(static_cast<Index>(k)) = whitened / whitened.norm();
  }
  const convex::Vector values = convex::linear_algebra::eigenvalues(unit.transpose() * unit);
  return values.maxCoeff() / std::max(values.minCoeff(), 0.0);
}

std::vector<Index> weak_rows(const NearestPointProblem& problem, const convex::ExactMultipliers& found) {
  std::vector<Index> weak;
  for (const Index a : found.tight) {
    if (problem.is_two_sided(a)) continue;
    const auto row = static_cast<std::size_t>(a);
    const bool is_zero = found.least_norm.numerators[row].is_zero();
    const bool may_press =
        found.ranges && (!(*found.ranges)[row].high || sign(*(*found.ranges)[row].high) != 0);
    if (is_zero && (found.unique || (found.ranges && !may_press))) weak.push_back(a);
  }
  return weak;
}

void write_decimals(JsonWriter& json, const char* key, const ExactVector& x) {
  json.key(key).begin_array();
  for (Index i = 0; i < x.size(); ++i)
    json.value(decimal_text(entry(x, static_cast<std::size_t>(i)), digits_of_truth));
  json.end_array();
}

/// The fractions, or null where one of them is long.
void write_fractions(JsonWriter& json, const char* key, const ExactVector& x) {
  std::vector<std::string> texts;
  for (Index i = 0; i < x.size(); ++i) texts.push_back(text(entry(x, static_cast<std::size_t>(i))));
  json.key(key);
  const bool is_long = std::any_of(texts.begin(), texts.end(),
                                   [](const std::string& one) { return one.size() > longest_fraction; });
  if (is_long) {
    json.null();
    return;
  }
  json.begin_array();
  for (const std::string& one : texts) json.value(one);
  json.end_array();
}

void write_rows(JsonWriter& json, const char* key, const std::vector<Index>& rows) {
  json.key(key).begin_array();
  for (const Index a : rows) json.value(a);
  json.end_array();
}

}  // namespace

LibraryTruth library_truth(const NearestPointProblem& problem) {
  const convex::ExactProblem exact = convex::exact_problem(problem);
  LibraryTruth truth;
  truth.solution = convex::exact_active_set(exact, convex::likely_active_rows(problem));
  truth.condition = convex::spectrum(problem.A).condition();
  if (!truth.feasible()) return truth;
  truth.multipliers = convex::exact_multipliers(exact, truth.solution, false);
  if (!truth.multipliers.unique && problem.rows() <= most_ranges_in_fractions)
    truth.multipliers = convex::exact_multipliers(exact, truth.solution, true);
  truth.weak = weak_rows(problem, truth.multipliers);
  truth.active_condition = condition_of_rows(problem, truth.solution.basis);
  return truth;
}

std::string truth_json(const LibraryProblem& problem, const LibraryTruth& truth) {
  JsonWriter json;
  json.begin_object().key("problem").value(problem.name).key("origin").value(problem.origin);
  json.key("status").value(truth.feasible() ? "solved" : "infeasible");
  if (truth.feasible()) {
    write_decimals(json, "acceleration", truth.solution.q);
    write_decimals(json, "multipliers", truth.multipliers.least_norm);
    json.key("multipliers_unique").value(truth.multipliers.unique);
    write_rows(json, "active", truth.multipliers.tight);
    write_rows(json, "weak", truth.weak);
    json.key("exact").begin_object();
    write_fractions(json, "acceleration", truth.solution.q);
    write_fractions(json, "multipliers", truth.multipliers.least_norm);
    json.end_object();
  } else {
    json.key("farkas").begin_array();
    for (const convex::Integer& weight : truth.solution.farkas) json.value(weight.text());
    json.end_array();
  }
  for (const auto& [key, names] :
       {std::pair{"coordinates", &problem.coordinates}, {"constraints", &problem.constraints}}) {
    if (names->empty()) continue;
    json.key(key).begin_array();
    for (const std::string& name : *names) json.value(name);
    json.end_array();
  }
  return json.end_object().text();
}

std::string index_heading() {
  return "problem,kind,class,n,m,two_sided,status,active,weak,dependent,multipliers_unique,condition,active_"
         "condition,"
         "origin\n";
}

std::string index_line(const LibraryProblem& problem, const LibraryTruth& truth) {
  const NearestPointProblem& numbers = problem.problem;
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{:.2g},{:.2g},\"{}\"\n", problem.name, problem.kind,
                     problem.family, numbers.dimension(), numbers.rows(), numbers.two_sided.size(),
                     truth.feasible() ? "solved" : "infeasible", truth.multipliers.tight.size(),
                     truth.weak.size(), truth.dependent(),
                     truth.feasible() ? (truth.multipliers.unique ? "1" : "0") : "", truth.condition,
                     truth.active_condition, problem.origin);
}

}  // namespace cli::inline measurement
