#include "cli/report/impact_laws_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/json_writer.hpp"
#include "cli/motion_files.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"
#include "mechanics/motion/impulses.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using mechanics::ImpactLaw;
using mechanics::ImpactOutcome;
using mechanics::ImpactScene;

/// v + change, 0 where that is the rounding of velocities that T allows the coordinate: sqrt(2 T (A⁻¹)_ii).
double velocity_after(const ImpactScene& scene, const ImpactOutcome& outcome, Index i) {
  const convex::Vector column = scene.A.solve(convex::Vector::Unit(scene.velocity.size(), i));
  return without_rounding(scene.velocity[i] + outcome.change[i], std::sqrt(2 * scene.kinetic * column[i]));
}

/// T+ = T- + (v+ - v-)·(A (v+ + v-)/2 + b).
double kinetic_after(const ImpactScene& scene, const ImpactOutcome& outcome) {
  const convex::Vector middle = scene.velocity + 0.5 * outcome.change;
  return scene.kinetic + outcome.change.dot(scene.A.multiply(middle) + scene.b);
}

std::string trouble(const FollowedMotion& followed, const ImpactScene& scene, const ImpactOutcome& outcome) {
  if (outcome.excluding.empty()) return std::string(outcome.undetermined);
  const std::vector<std::string> names = constraint_names(followed.system);
  std::string text = "no velocity satisfies";
  for (const Index k : outcome.excluding)
    text += " " + names[static_cast<std::size_t>(scene.constraints[static_cast<std::size_t>(k)])];
  return text;
}

/// What a law makes of the impact; where P is left open, that of least norm.
struct LawOutcome : ImpactOutcome {
  bool has_one_impulse = true;
};

LawOutcome outcome_of(const ImpactScene& scene, ImpactLaw law) {
  LawOutcome outcome{mechanics::impact(scene.A, scene.contacts, law)};
  if (outcome.impulse.size() == 0) return outcome;
  mechanics::Impulses all = law == ImpactLaw::moreau
                                ? mechanics::moreau_impulses(scene.A, scene.contacts)
                                : mechanics::impulses_of(scene.A, scene.contacts, outcome);
  outcome.has_one_impulse = all.unique;
  if (!all.unique) outcome.impulse = std::move(all.least_norm);
  return outcome;
}

std::vector<std::string> contact_names(const FollowedMotion& followed, const ImpactScene& scene) {
  const std::vector<std::string> names = constraint_names(followed.system);
  std::vector<std::string> chosen;
  for (const Index a : scene.constraints) chosen.push_back(names[static_cast<std::size_t>(a)]);
  return chosen;
}

/// In the order of `mechanics::impact_laws`.
using Outcomes = std::vector<LawOutcome>;

Outcomes outcomes_of(const ImpactScene& scene) {
  Outcomes outcomes;
  for (const ImpactLaw law : mechanics::impact_laws) outcomes.push_back(outcome_of(scene, law));
  return outcomes;
}

Exit exit_of(const Outcomes& outcomes) {
  const bool is_excluded = std::all_of(outcomes.begin(), outcomes.end(),
                                       [](const LawOutcome& outcome) { return !outcome.excluding.empty(); });
  return is_excluded ? Exit::no_solution : Exit::solved;
}

std::string impact_laws_json(const FollowedMotion& followed, const ImpactScene* scene,
                             const Outcomes& outcomes) {
  JsonWriter json;
  json.begin_object().key("file").value(followed.file).key("kind").value("system");
  if (scene == nullptr) {
    json.key("status").value("stopped").key("why").value("there is no impact before the end");
    return json.end_object().text() + "\n";
  }
  const std::vector<std::string> contacts = contact_names(followed, *scene);
  json.key("status")
      .value(exit_of(outcomes) == Exit::solved ? "done" : "infeasible")
      .key("t")
      .value(scene->t)
      .key("velocity_before");
  json.numbers(followed.system.coordinates(), scene->velocity).key("kinetic_before").value(scene->kinetic);
  json.key("laws").begin_object();
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const LawOutcome& outcome = outcomes[k];
    json.key(mechanics::name(mechanics::impact_laws[k])).begin_object();
    if (const std::string why = trouble(followed, *scene, outcome); !why.empty()) {
      json.key("why").value(why).end_object();
      continue;
    }
    json.key("velocity_after").numbers(followed.system.coordinates(), scene->velocity + outcome.change);
    json.key("impulses").numbers(contacts, outcome.impulse);
    json.key("impulses_unique").value(outcome.has_one_impulse);
    json.key("kinetic_after").value(kinetic_after(*scene, outcome));
    if (!outcome.remark.empty()) json.key("remark").value(outcome.remark);
    json.end_object();
  }
  return json.end_object().end_object().text() + "\n";
}

std::string impact_laws_text(const FollowedMotion& followed, const ImpactScene* scene,
                             const Outcomes& outcomes) {
  std::string text = heading(followed.title, followed.file);
  if (scene == nullptr)
    return text + fmt::format("There is no impact before t = {}.\n", followed.motion.state().t);
  text += fmt::format("The first impact is at t = {}; T before it is {}.\n\n", scene->t,
                      number_text(scene->kinetic));
  std::vector<std::string> head{"", "before"};
  std::string said;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const std::string law = mechanics::name(mechanics::impact_laws[k]);
    head.push_back(law);
    std::string why = trouble(followed, *scene, outcomes[k]);
    if (why.empty()) why = std::string(outcomes[k].remark);
    if (!why.empty()) said += law + ": " + why + ".\n";
    if (!outcomes[k].has_one_impulse)
      said += law + ": v+ is unique, P is not: others give the same v+; these have the least norm.\n";
  }
  TextTable table(head);
  const auto add = [&](const std::string& what, const std::string& before, auto&& number) {
    std::vector<std::string> row{what, before};
    for (const ImpactOutcome& outcome : outcomes)
      row.push_back(outcome.change.size() > 0 ? number_text(number(outcome)) : "");
    table.add(std::move(row));
  };
  for (Index i = 0; i < scene->velocity.size(); ++i)
    add(followed.system.coordinates()[static_cast<std::size_t>(i)] + "'", number_text(scene->velocity[i]),
        [&](const ImpactOutcome& outcome) { return velocity_after(*scene, outcome, i); });
  const std::vector<std::string> contacts = contact_names(followed, *scene);
  for (std::size_t a = 0; a < contacts.size(); ++a)
    add("P of " + contacts[a], "",
        [&](const ImpactOutcome& outcome) { return outcome.impulse[static_cast<Index>(a)]; });
  add("T", number_text(scene->kinetic), [&](const ImpactOutcome& outcome) {
    return without_rounding(kinetic_after(*scene, outcome), scene->kinetic);
  });
  return text + table.text() + (said.empty() ? "" : "\n" + said);
}

}  // namespace

Answer impact_laws_answer(const FollowedMotion& followed, bool json) {
  const auto& first = followed.motion.record().first_impact;
  const ImpactScene* scene = first ? &*first : nullptr;
  const Outcomes outcomes = first ? outcomes_of(*first) : Outcomes{};
  return {first ? exit_of(outcomes) : Exit::inaccurate,
          json ? impact_laws_json(followed, scene, outcomes) : impact_laws_text(followed, scene, outcomes)};
}

}  // namespace cli::inline reports
