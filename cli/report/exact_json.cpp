#include "cli/report/exact_json.hpp"

#include <algorithm>

namespace cli::inline reports {
namespace {

using convex::ExactVector;
using convex::Fraction;

void write_fractions(JsonWriter& json, const std::vector<std::string>& names, const ExactVector& x) {
  json.begin_object();
  for (std::size_t i = 0; i < names.size(); ++i) json.key(names[i]).value(convex::text(convex::entry(x, i)));
  json.end_object();
}

/// An exact solution with the constraints that are its rows.
struct ExactAnswer {
  const Scene& scene;
  const std::vector<convex::Index>& K;

  /// Fractions over K spread over all constraints, 0 elsewhere.
  ExactVector over_constraints(const ExactVector& x) const {
    ExactVector all{convex::IntegerVector(scene.constraints.size(), 0), x.denominator};
    for (std::size_t k = 0; k < K.size(); ++k)
      all.numerators[static_cast<std::size_t>(K[k])] = x.numerators[k];
    return all;
  }
};

void write_ranges(JsonWriter& json, const ExactAnswer& answer,
                  const std::vector<convex::ExactInterval>& ranges) {
  const Scene& scene = answer.scene;
  std::vector<convex::ExactInterval> all(scene.constraints.size(), {Fraction{}, Fraction{}});
  for (std::size_t k = 0; k < answer.K.size(); ++k) all[static_cast<std::size_t>(answer.K[k])] = ranges[k];
  json.begin_object();
  for (std::size_t a = 0; a < all.size(); ++a)
    json.key(scene.constraints[a])
        .begin_array()
        .value(all[a].low ? convex::text(*all[a].low) : "-inf")
        .value(all[a].high ? convex::text(*all[a].high) : "inf")
        .end_array();
  json.end_object();
}

void write_null_space(JsonWriter& json, const ExactAnswer& answer,
                      const convex::ExactMultipliers& multipliers) {
  json.key("null_space").begin_array();
  for (const auto& mu : multipliers.null_space) {
    json.begin_object();
    for (const auto& [row, coefficient] : mu)
      json.key(answer.scene.contact_name(row)).value(convex::text(coefficient));
    json.end_object();
  }
  json.end_array();
}

void write_solution(JsonWriter& json, const ExactAnswer& answer, const mechanics::ExactGaussSolution& exact,
                    bool null_space) {
  const Scene& scene = answer.scene;
  if (exact.primal.status == convex::Status::infeasible) {
    json.key("farkas");
    write_fractions(json, scene.constraints, answer.over_constraints({exact.primal.farkas, 1}));
    return;
  }
  json.key("acceleration");
  write_fractions(json, scene.coordinates, exact.primal.q);
  json.key("multipliers");
  write_fractions(json, scene.constraints, answer.over_constraints(exact.multipliers.least_norm));
  json.key("reaction");
  write_fractions(json, scene.coordinates, exact.reaction);
  json.key("gauss").value(convex::text(exact.gauss));
  if (exact.multipliers.ranges && !exact.multipliers.unique) {
    json.key("multiplier_ranges");
    write_ranges(json, answer, *exact.multipliers.ranges);
  }
  if (null_space) write_null_space(json, answer, exact.multipliers);
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
  // What the file declares to be in contact is, whatever the digits of the state found say.
  const std::vector<convex::Index>& declared = scene.written->in_contact;
  for (std::size_t a = 0; a < proof.contacts.size(); ++a)
    json.key(scene.constraints[a])
        .value(std::binary_search(declared.begin(), declared.end(), static_cast<convex::Index>(a))
                   ? "declared"
                   : name(proof.contacts[a]));
  json.end_object();
  json.key("contacts_hold").value(proof.contacts_hold);
  const auto write_names = [&](const char* key, const std::vector<convex::Index>& named) {
    if (named.empty()) return;
    json.key(key).begin_array();
    for (const convex::Index a : named) json.value(scene.constraints[static_cast<std::size_t>(a)]);
    json.end_array();
  };
  write_names("dependent", proof.dependent);
  write_names("vanishing", proof.vanishing);
  json.key("error_bound");
  if (proof.error_bound)
    json.value(*proof.error_bound);
  else
    json.null();
  if (proof.exact) write_solution(json, {scene, proof.K}, *proof.exact, false);
  if (proof.acceleration) {
    json.key("acceleration").begin_object();
    for (std::size_t i = 0; i < scene.coordinates.size(); ++i)
      json.key(scene.coordinates[i]).value(proof.acceleration->entries[i]);
    json.end_object().key("radius").value(proof.acceleration->radius);
  } else if (proof.enclosed) {
    json.key("farkas");
    write_fractions(json, scene.constraints,
                    ExactAnswer{scene, proof.K}.over_constraints({proof.enclosed->farkas, 1}));
  }
  json.end_object();
}

/// The weights of a contradiction that was proved, if it was, over all constraints.
std::optional<ExactVector> proved_farkas(const SolvedScene& solved) {
  const mechanics::TextProof* text = solved.text;
  const auto over = [&](const std::vector<convex::Index>& K, const convex::IntegerVector& weights) {
    return weights.empty() ? std::nullopt
                           : std::optional(ExactAnswer{solved.scene, K}.over_constraints({weights, 1}));
  };
  if (solved.exact != nullptr) return over(solved.scene.contacts, solved.exact->primal.farkas);
  if (!solved.farkas.empty()) return over(solved.scene.contacts, solved.farkas);
  if (text != nullptr && text->exact) return over(text->K, text->exact->primal.farkas);
  return text != nullptr && text->enclosed ? over(text->K, text->enclosed->farkas) : std::nullopt;
}

}  // namespace

void write_certificate(JsonWriter& json, const SolvedScene& solved) {
  json.key("certificate").begin_object().key("level");
  if (solved.certificate)
    json.value(name(solved.certificate->level)).key("error_bound").value(solved.certificate->error_bound);
  else
    json.value("estimate").key("error_bound").value(solved.solution.primal.error_bound);
  if (solved.as_evaluated) json.key("as_evaluated").value(*solved.as_evaluated);
  json.end_object();
}

void write_exact(JsonWriter& json, const SolvedScene& solved) {
  if (solved.exact != nullptr) {
    json.key("exact").begin_object();
    write_solution(json, {solved.scene, solved.scene.contacts}, *solved.exact, solved.null_space);
    json.end_object();
  }
  if (solved.text != nullptr) write_text_proof(json, solved.scene, *solved.text);
}

void write_farkas(JsonWriter& json, const SolvedScene& solved) {
  json.key("farkas");
  const convex::Vector rounded = solved.scene.over_constraints(solved.solution.primal.farkas);
  const std::optional<ExactVector> proof = proved_farkas(solved);
  if (!proof) {
    json.numbers(solved.scene.constraints, rounded);
    return;
  }
  const ExactVector& exact = *proof;
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

}  // namespace cli::inline reports
