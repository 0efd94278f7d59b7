#include "cli/exact_json.hpp"

namespace cli {
namespace {

using convex::ExactVector;
using convex::Fraction;

const char* name(convex::ProofLevel level) {
  switch (level) {
    case convex::ProofLevel::none:
      return "none";
    case convex::ProofLevel::enclosure:
      return "enclosure";
    case convex::ProofLevel::exact:
      return "exact";
  }
  return "";
}

void write_fractions(JsonWriter& json, const std::vector<std::string>& names, const ExactVector& x) {
  json.begin_object();
  for (std::size_t i = 0; i < names.size(); ++i) json.key(names[i]).value(convex::text(convex::entry(x, i)));
  json.end_object();
}

/// Fractions over K spread over all constraints, 0 elsewhere.
ExactVector over_constraints(const Scene& scene, const ExactVector& x) {
  ExactVector all{convex::IntegerVector(scene.constraints.size(), 0), x.denominator};
  for (std::size_t k = 0; k < scene.contacts.size(); ++k)
    all.numerators[static_cast<std::size_t>(scene.contacts[k])] = x.numerators[k];
  return all;
}

void write_ranges(JsonWriter& json, const Scene& scene, const std::vector<convex::ExactInterval>& ranges) {
  std::vector<convex::ExactInterval> all(scene.constraints.size(), {Fraction{}, Fraction{}});
  for (std::size_t k = 0; k < scene.contacts.size(); ++k)
    all[static_cast<std::size_t>(scene.contacts[k])] = ranges[k];
  json.begin_object();
  for (std::size_t a = 0; a < all.size(); ++a)
    json.key(scene.constraints[a])
        .begin_array()
        .value(all[a].low ? convex::text(*all[a].low) : "-inf")
        .value(all[a].high ? convex::text(*all[a].high) : "inf")
        .end_array();
  json.end_object();
}

void write_null_space(JsonWriter& json, const Scene& scene, const convex::ExactMultipliers& multipliers) {
  json.key("null_space").begin_array();
  for (const auto& mu : multipliers.null_space) {
    json.begin_object();
    for (const auto& [row, coefficient] : mu)
      json.key(scene.contact_name(row)).value(convex::text(coefficient));
    json.end_object();
  }
  json.end_array();
}

void write_solution(JsonWriter& json, const Scene& scene, const mechanics::ExactGaussSolution& exact,
                    bool null_space) {
  if (exact.primal.status == convex::Status::infeasible) {
    json.key("farkas");
    write_fractions(json, scene.constraints, over_constraints(scene, {exact.primal.farkas, 1}));
    return;
  }
  json.key("acceleration");
  write_fractions(json, scene.coordinates, exact.primal.q);
  json.key("multipliers");
  write_fractions(json, scene.constraints, over_constraints(scene, exact.multipliers.least_norm));
  json.key("reaction");
  write_fractions(json, scene.coordinates, exact.reaction);
  json.key("gauss").value(convex::text(exact.gauss));
  if (exact.multipliers.ranges && !exact.multipliers.unique) {
    json.key("multiplier_ranges");
    write_ranges(json, scene, *exact.multipliers.ranges);
  }
  if (null_space) write_null_space(json, scene, exact.multipliers);
}

const char* name(mechanics::ContactVerdict verdict) {
  switch (verdict) {
    case mechanics::ContactVerdict::touches:
      return "touches";
    case mechanics::ContactVerdict::apart:
      return "apart";
    case mechanics::ContactVerdict::violated:
      return "violated";
    case mechanics::ContactVerdict::undecided:
      return "undecided";
  }
  return "";
}

void write_text_proof(JsonWriter& json, const Scene& scene, const mechanics::TextProof& proof) {
  json.key("from_text").begin_object().key("contacts").begin_object();
  for (std::size_t a = 0; a < proof.contacts.size(); ++a)
    json.key(scene.constraints[a]).value(name(proof.contacts[a]));
  json.end_object();
  json.key("contacts_hold").value(proof.contacts_hold);
  json.key("error_bound");
  if (proof.error_bound)
    json.value(*proof.error_bound);
  else
    json.null();
  if (proof.exact) write_solution(json, scene, *proof.exact, false);
  if (proof.acceleration) {
    json.key("acceleration").begin_object();
    for (std::size_t i = 0; i < scene.coordinates.size(); ++i)
      json.key(scene.coordinates[i]).value(proof.acceleration->entries[i]);
    json.end_object().key("radius").value(proof.acceleration->radius);
  } else if (proof.enclosed) {
    json.key("farkas");
    write_fractions(json, scene.constraints, over_constraints(scene, {proof.enclosed->farkas, 1}));
  }
  json.end_object();
}

/// The weights of a contradiction that was proved, if it was.
const convex::IntegerVector* proved_farkas(const SolvedScene& solved) {
  if (solved.exact != nullptr) return &solved.exact->primal.farkas;
  if (!solved.farkas.empty()) return &solved.farkas;
  if (solved.text == nullptr) return nullptr;
  if (solved.text->exact) return &solved.text->exact->primal.farkas;
  return solved.text->enclosed ? &solved.text->enclosed->farkas : nullptr;
}

}  // namespace

void write_certificate(JsonWriter& json, const SolvedScene& solved) {
  json.key("certificate").begin_object().key("level");
  if (solved.certificate)
    json.value(name(solved.certificate->level)).key("error_bound").value(solved.certificate->error_bound);
  else
    json.value("estimate").key("error_bound").value(solved.solution.primal.error_bound);
  json.end_object();
}

void write_exact(JsonWriter& json, const SolvedScene& solved) {
  if (solved.exact != nullptr) {
    json.key("exact").begin_object();
    write_solution(json, solved.scene, *solved.exact, solved.null_space);
    json.end_object();
  }
  if (solved.text != nullptr) write_text_proof(json, solved.scene, *solved.text);
}

void write_farkas(JsonWriter& json, const SolvedScene& solved) {
  json.key("farkas");
  const convex::Vector rounded = solved.scene.over_constraints(solved.solution.primal.farkas);
  const convex::IntegerVector* proof = proved_farkas(solved);
  if (proof == nullptr || proof->empty()) {
    json.numbers(solved.scene.constraints, rounded);
    return;
  }
  const ExactVector exact = over_constraints(solved.scene, {*proof, 1});
  json.begin_object();
  for (std::size_t a = 0; a < exact.numerators.size(); ++a) {
    json.key(solved.scene.constraints[a]);
    constexpr std::size_t mantissa = 53;
    if (exact.numerators[a].bits() <= mantissa)
      json.value(convex::nearest_quotient(exact.numerators[a], 1));
    else
      json.value(exact.numerators[a].text());
  }
  json.end_object();
}

}  // namespace cli
