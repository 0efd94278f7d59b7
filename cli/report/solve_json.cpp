#include <numeric>

#include "cli/json_writer.hpp"
#include "cli/report/exact_json.hpp"
#include "cli/report/model_report.hpp"
#include "cli/report/sensitivity_json.hpp"
#include "cli/report/singular_report.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::Vector;

void write_active(JsonWriter& json, const SolvedScene& solved) {
  json.key("active").begin_array();
  for (std::size_t a = 0; a < solved.states.size(); ++a)
    if (solved.states[a] == ConstraintState::persists || solved.states[a] == ConstraintState::touches)
      json.value(solved.scene.constraints[a]);
  json.end_array();
}

void write_ranges(JsonWriter& json, const SolvedScene& solved) {
  json.key("multiplier_ranges");
  if (!solved.solution.multipliers.ranges) {
    json.null();
    return;
  }
  std::vector<convex::Interval> all(solved.scene.constraints.size());
  for (std::size_t k = 0; k < solved.scene.contacts.size(); ++k)
    all[static_cast<std::size_t>(solved.scene.contacts[k])] = (*solved.solution.multipliers.ranges)[k];
  json.begin_object();
  for (std::size_t a = 0; a < all.size(); ++a) {
    json.key(solved.scene.constraints[a]);
    if (solved.is_weighed(a))
      json.null();
    else
      json.begin_array().value(all[a].low).value(all[a].high).end_array();
  }
  json.end_object();
}

/// By constraint; null where an added row weighs it.
void write_multipliers(JsonWriter& json, const SolvedScene& solved, const std::vector<Index>& constraints,
                       const Vector& lambda) {
  json.begin_object();
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const auto a = static_cast<std::size_t>(constraints[k]);
    json.key(solved.scene.constraints[a]);
    if (solved.is_weighed(a))
      json.null();
    else
      json.value(lambda[static_cast<Index>(k)]);
  }
  json.end_object();
}

void write_null_space(JsonWriter& json, const SolvedScene& solved) {
  if (!solved.null_space) return;
  json.key("null_space");
  if (!solved.solution.multipliers.null_space) {
    json.null();
    return;
  }
  json.begin_array();
  for (const convex::NullVector& mu : *solved.solution.multipliers.null_space) {
    json.begin_object();
    for (const auto& [row, coefficient] : mu) json.key(solved.scene.contact_name(row)).value(coefficient);
    json.end_object();
  }
  json.end_array();
}

void write_hypothesis(JsonWriter& json, const SolvedScene& solved) {
  const mechanics::Hypothesis& hypothesis = solved.solution.hypothesis;
  const bool consistent = hypothesis.two_sided.consistent;
  json.key("two_sided").begin_object().key("consistent").value(consistent);
  json.key("acceleration");
  if (consistent)
    json.numbers(solved.scene.coordinates, hypothesis.two_sided.acceleration);
  else
    json.begin_object().end_object();
  json.key("multipliers");
  if (consistent)
    write_multipliers(json, solved, solved.scene.contacts, hypothesis.two_sided.multipliers);
  else
    json.begin_object().end_object();
  json.end_object();
  json.key("hypothesis")
      .begin_object()
      .key("accepted")
      .value(hypothesis.accepted)
      .key("drop_negative_is_right");
  if (hypothesis.drop_negative_is_right)
    json.value(*hypothesis.drop_negative_is_right);
  else
    json.null();
  json.end_object();
}

void write_residuals(JsonWriter& json, const convex::Residuals& residuals) {
  json.key("residuals").begin_object();
  json.key("feasibility")
      .value(residuals.feasibility)
      .key("complementarity")
      .value(residuals.complementarity);
  json.key("stationarity").value(residuals.stationarity).key("duality_gap").value(residuals.duality_gap);
  json.end_object();
}

void write_constraints(JsonWriter& json, const SolvedScene& solved) {
  json.key("constraints").begin_object();
  for (std::size_t a = 0; a < solved.states.size(); ++a) {
    const Index i = static_cast<Index>(a);
    json.key(solved.scene.constraints[a]).begin_object().key("state").value(name(solved.states[a]));
    json.key("f").value(solved.scene.rates ? solved.scene.rates->f[i] : 0.0);
    json.key("df").value(solved.scene.rates ? solved.scene.rates->df[i] : 0.0);
    json.key("ddf").value(solved.second_rates[i]).end_object();
  }
  json.end_object();
}

void write_answer(JsonWriter& json, const SolvedScene& solved) {
  const mechanics::GaussSolution& solution = solved.solution;
  write_active(json, solved);
  json.key("acceleration").numbers(solved.scene.coordinates, solution.primal.q);
  std::vector<Index> all(solved.scene.constraints.size());
  std::iota(all.begin(), all.end(), Index{0});
  json.key("multipliers");
  write_multipliers(json, solved, all, solved.scene.over_constraints(solution.multipliers.least_norm));
  json.key("multipliers_unique").value(solved.multipliers_are_unique());
  write_ranges(json, solved);
  write_null_space(json, solved);
  json.key("reaction").numbers(solved.scene.coordinates, solution.reaction);
  json.key("gauss").value(solution.gauss);
  write_hypothesis(json, solved);
  write_residuals(json, solution.residuals);
  write_constraints(json, solved);
  json.key("reaction_from_dual");
  if (solution.from_dual)
    json.begin_object()
        .key("reaction")
        .numbers(solved.scene.coordinates, solution.from_dual->reaction)
        .key("difference")
        .value(solution.from_dual->difference)
        .end_object();
  else
    json.null();
  write_model(json, solved);
  write_certificate(json, solved);
  write_exact(json, solved);
}

}  // namespace

void write_solved(JsonWriter& json, const SolvedScene& solved) {
  json.key("file").value(solved.scene.file).key("kind").value(solved.scene.kind);
  json.key("status")
      .value(name(solved.solution.primal.status))
      .key("method")
      .value(solved.solution.primal.method);
  if (solved.solution.primal.polished) json.key("polished").value(true);
  if (solved.infeasible())
    write_farkas(json, solved);
  else if (solved.has_answer())
    write_answer(json, solved);
  write_added_rows(json, solved);
  if (solved.sensitivity && solved.has_answer()) write_sensitivity(json, solved);
  if (solved.infeasible() && solved.certificate) {
    write_certificate(json, solved);
    write_exact(json, solved);
  }
  write_warnings(json, solved);
  if (!solved.closed_by_tolerance.empty()) {
    json.key("closed_by_tolerance").begin_array();
    for (const Index a : solved.closed_by_tolerance)
      json.value(solved.scene.constraints[static_cast<std::size_t>(a)]);
    json.end_array();
  }
  json.key("seconds").value(solved.seconds);
}

std::string solve_json(const SolvedScene& solved) {
  JsonWriter json;
  json.begin_object();
  write_solved(json, solved);
  return json.end_object().text();
}

}  // namespace cli::inline reports
