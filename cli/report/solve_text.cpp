#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/report/model_report.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/sensitivity_text.hpp"
#include "cli/report/singular_report.hpp"
#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"
#include "convex/exact/ball.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "mechanics/exact_gauss_solution.hpp"
#include "mechanics/gauss_laws.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;

constexpr auto shown_rows = static_cast<std::size_t>(most_rows);

std::string cut(std::size_t total, const char* what) {
  return total > shown_rows ? fmt::format("  … and {} more {}; --json gives all\n", total - shown_rows, what)
                            : "";
}

/// "Persist: a and b. Opens: c." of the contacts, in their order.
std::string verdict_line(const SolvedScene& solved) {
  struct Group {
    ConstraintState state;
    const char *one, *many;
    std::vector<std::string> names = {};
  };
  std::vector<Group> groups{{ConstraintState::persists, "Persists", "Persist"},
                            {ConstraintState::touches, "Only touches", "Only touch"},
                            {ConstraintState::opens, "Opens", "Open"}};
  for (std::size_t a = 0; a < solved.states.size(); ++a)
    for (Group& group : groups)
      if (solved.states[a] == group.state) group.names.push_back(solved.scene.constraints[a]);
  std::string text;
  for (const Group& group : groups)
    if (!group.names.empty())
      text += fmt::format("{}{}: {}.", text.empty() ? "" : " ",
                          group.names.size() == 1 ? group.one : group.many, listed(group.names));
  if (text.empty()) text = solved.states.empty() ? "There is no constraint." : "Nothing is in contact.";
  return text + "\n\n";
}

std::string constraint_table(const SolvedScene& solved, const ReadableNumbers& read) {
  if (solved.states.empty()) return "";
  const bool is_system = solved.scene.rates.has_value(),
             forces = std::any_of(read.forces.begin(), read.forces.end(),
                                  [](const auto&force) { return force.has_value(); });
  std::vector<std::string> head =
      is_system ? std::vector<std::string>{"constraint", "state", "f", "df/dt", "d²f/dt²", "lambda"}
                : std::vector<std::string>{"constraint", "state", "u·q''- s", "lambda"};
  if (forces) head.emplace_back("|lambda grad f|");
  TextTable table(std::move(head));
  for (std::size_t a = 0; a < std::min(solved.states.size(), shown_rows); ++a) {
    const Index i = static_cast<Index>(a);
    std::vector<std::string> row{solved.scene.constraints[a] + (solved.scene.two_sided[a] ? " (=)" : ""),
                                 name(solved.states[a])};
    if (is_system) {
      row.push_back(number_text(read.f[i]));
      row.push_back(number_text(read.df[i]));
    }
    row.push_back(number_text(read.second_rates[i]));
    const bool is_weighed = solved.is_weighed(a);
    row.push_back(is_weighed ? "-" : number_text(read.lambda[i]));
    if (forces) row.push_back(!is_weighed && read.forces[a] ? number_text(*read.forces[a]) : "");
    table.add(std::move(row));
  }
  return table.text() + cut(solved.states.size(), "constraints") + "\n";
}

std::string coordinate_table(const SolvedScene& solved, const ReadableNumbers& read) {
  TextTable table({"coordinate", "acceleration", "reaction"});
  for (Index i = 0; i < read.acceleration.size(); ++i)
    table.add({solved.scene.coordinates[static_cast<std::size_t>(i)], number_text(read.acceleration[i]),
               number_text(read.reaction[i])});
  return table.text() + cut(solved.scene.coordinates.size(), "coordinates") + "\n";
}

std::string uniqueness_text(const SolvedScene& solved, const ReadableNumbers& read) {
  const convex::Multipliers& multipliers = solved.solution.multipliers;
  if (solved.multipliers_are_unique()) return "";
  std::string text =
      fmt::format("The multipliers are not unique (the acceleration and the reaction are); shown are {}.\n",
                  multipliers.is_least_norm ? "those of least norm" : "some");
  if (read.ranges.empty()) return text;
  std::vector<std::string> parts;
  for (Index row : multipliers.tight) {
    const auto k = static_cast<std::size_t>(row);
    if (k < solved.scene.contacts.size() &&
        solved.is_weighed(static_cast<std::size_t>(solved.scene.contacts[k])))
      continue;
    const convex::Interval range = read.ranges[static_cast<std::size_t>(row)];
    parts.push_back(fmt::format("{} in [{}, {}]", solved.scene.contact_name(row), number_text(range.low),
                                number_text(range.high)));
  }
  return text + "Each may be anywhere in its range: " + listed(parts) + ".\n";
}

bool is_proved(const std::optional<convex::Certificate>& certificate) {
  return certificate && certificate->level != convex::ProofLevel::none;
}

std::string constraints_text(const SolvedScene& solved, const std::vector<Index>& chosen) {
  std::vector<std::string> names;
  for (const Index a : chosen) names.push_back(solved.scene.constraints[static_cast<std::size_t>(a)]);
  return listed(names);
}

/// Constraints that the tolerance took for contacts and the text does not, or the other way round.
std::string refuted_text(const SolvedScene& solved) {
  std::vector<Index> open, closed;
  for (const Index a : solved.text->refuted)
    (solved.text->contacts[static_cast<std::size_t>(a)] == mechanics::ContactVerdict::touches ? closed : open)
        .push_back(a);
  std::string text;
  if (!open.empty())
    text += fmt::format(
        "From the text: as written, {} {} not touch (f > 0, or df/dt > 0), though within "
        "contact_tolerance {} counted as touching",
        constraints_text(solved, open), open.size() == 1 ? "does" : "do", open.size() == 1 ? "it" : "they");
  if (!closed.empty())
    text += fmt::format("{}as written, {} {}, though f or df/dt as evaluated is beyond contact_tolerance",
                        text.empty() ? "From the text: " : "; ", constraints_text(solved, closed),
                        closed.size() == 1 ? "touches" : "touch");
  return text;
}

/// "y'' = 9/5, a'' = -6; lambda left 0, right 7/2": an exact answer over the constraints K, where its
/// fractions are short enough to be read.
std::string fractions_text(const Scene& scene, const mechanics::ExactGaussSolution& exact,
                           const std::vector<Index>& K) {
  constexpr std::size_t readable = 24, longest_line = 120;
  bool is_readable = true;
  const auto shown = [&](const convex::ExactVector& x, std::size_t i) {
    const std::string text = convex::text(convex::entry(x, i));
    is_readable = is_readable && text.size() <= readable;
    return text;
  };
  std::string text, multipliers;
  for (std::size_t i = 0; i < scene.coordinates.size(); ++i)
    text += fmt::format("{}{}'' = {}", i == 0 ? "" : ", ", scene.coordinates[i], shown(exact.primal.q, i));
  for (std::size_t k = 0; k < K.size(); ++k)
    multipliers += fmt::format("{} {} {}",
                               k > 0                      ? ","
                               : exact.multipliers.unique ? "; lambda"
                                                          : "; lambda of least norm",
                               scene.constraints[static_cast<std::size_t>(K[k])],
                               shown(exact.multipliers.least_norm, k));
  text += multipliers;
  return is_readable && text.size() <= longest_line ? "In fractions: " + text + ".\n" : "";
}

/// Of the mechanism as written where that is proved, else of the numbers that the method "exact" was given.
std::string fractions_text(const SolvedScene& solved) {
  if (solved.infeasible()) return "";
  const mechanics::TextProof* text = solved.text;
  if (text != nullptr)
    return text->exact && text->contacts_hold ? fractions_text(solved.scene, *text->exact, text->K) : "";
  return solved.exact != nullptr ? fractions_text(solved.scene, *solved.exact, solved.scene.contacts) : "";
}

/// What the text of a mechanism proves of the contacts, and of the answer.
std::string from_text_text(const SolvedScene& solved) {
  if (solved.text == nullptr) return "";
  const mechanics::TextProof& proof = *solved.text;
  constexpr const char* remedy =
      "; give the state exactly, as an expression or a fraction, or set contact_tolerance";
  std::string text;
  if (proof.contacts_hold)
    text = "From the text: the contacts of K are proved";
  else if (!proof.violated.empty())
    text = fmt::format("From the text: as written, {} {} not hold, by less than contact_tolerance{}",
                       constraints_text(solved, proof.violated), proof.violated.size() == 1 ? "does" : "do",
                       remedy);
  else if (!proof.refuted.empty())
    text = refuted_text(solved) + (is_proved(solved.certificate) ? ", which makes no difference" : remedy);
  else
    text = fmt::format(
        "From the text: contact is not decided for {}, no rule known here shows f and df/dt to be 0{}",
        constraints_text(solved, proof.open),
        is_proved(solved.certificate) ? ", which makes no difference"
        : !convex::Ball::why_none().empty()
            ? " (" + convex::Ball::why_none() + ")"
            : "; write the state or the constraint so that they cancel term by term");
  if (proof.error_bound && is_proved(solved.certificate) && !solved.infeasible())
    text += fmt::format("; the acceleration is that of the mechanism as written{} to {:.1e}",
                        solved.on_edge ? ", on the branch that is taken," : "", *proof.error_bound);
  else if (!is_proved(solved.certificate))
    text += proof.contacts_hold ? solved.infeasible()
                                      ? "; that they contradict each other is not proved from there"
                                      : "; no bound on the acceleration is proved from there"
                                : ". Nothing is proved of the mechanism as written";
  if (!proof.vanishing.empty())
    text += fmt::format(". The gradient of {} is 0 there: second derivatives do not tell what it asks for",
                        constraints_text(solved, proof.vanishing));
  if (!proof.dependent.empty())
    text += fmt::format(
        ". {} {} on other constraints within the rounding of the numbers, and the text does not tell: {} "
        "counted as dependent{}",
        constraints_text(solved, proof.dependent), proof.dependent.size() == 1 ? "depends" : "depend",
        proof.dependent.size() == 1 ? "it is" : "they are", solved.infeasible() ? "" : " and consistent");
  return text + ".\n";
}

const char* proof_text(const std::optional<convex::Certificate>& certificate) {
  if (!certificate) return "";
  switch (certificate->level) {
    case convex::ProofLevel::exact:
      return ", proved in fractions";
    case convex::ProofLevel::enclosure:
      return ", proved with bounds on every rounding";
    case convex::ProofLevel::none:
      return "; NOT proved";
  }
  return "";
}

/// The reaction by its second route, said when asked for or when it disagrees.
std::string dual_text(const SolvedScene& solved) {
  if (!solved.solution.from_dual) return "";
  constexpr double agreement = 1e-9;
  const convex::Solution& primal = solved.solution.primal;
  const double scale = std::max(primal.acceleration_norm, primal.force_norm);
  const double difference = solved.solution.from_dual->difference;
  constexpr const char* route = "The reaction found from the dual alone (Moreau 1966, section 5)";
  if (difference * scale <= agreement * std::max(scale, solved.solution.from_dual->apex_norm))
    return solved.verbose ? fmt::format("{} agrees to {}.\n", route, error_text(difference)) : "";
  // At rest both are roundings, and a part of them says nothing; so are forces of which large multipliers
  // leave little, and those that contacts nearly depending on each other share.
  const double known = mechanics::apart_by_rounding(solved.scene.problem, solved.solution);
  if (difference * scale <= known && primal.status == convex::Status::solved)
    return solved.verbose
               ? fmt::format("{} is as near as the error bound and the contacts let it: {:.1e} of {:.1e}.\n",
                             route, difference * scale, known)
               : "";
  return fmt::format("{} DIFFERS by {:.1e}: one of the two routes is inaccurate here.\n", route, difference);
}

/// Of which mechanism the accuracy speaks: contacts that the tolerance closed are not as they were written.
std::string mechanism_text(const SolvedScene& solved) {
  const std::vector<Index>& closed = solved.closed_by_tolerance;
  if (closed.empty() && solved.solution.primal.undecided == convex::open_question::dependence)
    return "the mechanism as written if the rows that may depend on each other do";
  if (closed.empty())
    return solved.on_edge ? "the mechanism as written, on the branch that is taken"
                          : "the mechanism as written";
  constexpr std::size_t most_told = 4;
  const std::vector<Index> told(
      closed.begin(), closed.begin() + static_cast<std::ptrdiff_t>(std::min(closed.size(), most_told)));
  const Index first = closed.front();
  return fmt::format(
      "the mechanism with {}{} closed: as written {} not, f = {} and df/dt = {} of {} are within "
      "contact_tolerance",
      constraints_text(solved, told), closed.size() > most_told ? " …" : "",
      closed.size() == 1 ? "it is" : "they are", number_text(solved.scene.rates->f[first]),
      number_text(solved.scene.rates->df[first]), solved.scene.constraints[static_cast<std::size_t>(first)]);
}

}  // namespace

std::string accuracy_text(const SolvedScene& solved) {
  const convex::Solution& primal = solved.solution.primal;
  const double scale = std::max(primal.acceleration_norm, primal.force_norm);
  const double relative = scale > 0 ? primal.error_bound / scale : primal.error_bound;
  if (!primal.q.allFinite())
    return "NOT solved: the acceleration is beyond what doubles hold; other units bring it back.\n";
  if (!std::isfinite(primal.error_bound))
    return fmt::format("NOT solved: {} gives this acceleration, and nothing is known of its error.\n",
                       primal.method);
  // A part of nothing says nothing: where the bound is not below the acceleration and the forces, it is told
  // itself.
  const bool may_be_zero = scale > 0 && relative >= 1 && primal.status == convex::Status::solved;
  const double unit = scale > 0 && !may_be_zero ? scale : 1;
  const std::string bound =
      relative > 0
          ? fmt::format("{}error of the acceleration at most {}{}{}", may_be_zero ? "" : "relative ",
                        is_proved(solved.certificate) ? "" : "about ", error_text(primal.error_bound / unit),
                        may_be_zero ? " in the kinetic norm (it may be 0)" : "")
          : "the acceleration is exact";
  std::string accuracy = bound + proof_text(solved.certificate);
  const std::string mechanism = mechanism_text(solved);
  if (solved.as_evaluated && solved.verbose)
    accuracy +=
        fmt::format(" for {}, {:.1e} for A, z, U, s as evaluated", mechanism, *solved.as_evaluated / unit);
  else if (solved.as_evaluated || (solved.solution.as_written && solved.scene.written))
    accuracy += " for " + mechanism;
  else if (solved.scene.written && !(solved.text != nullptr && is_proved(solved.certificate)))
    accuracy += ", for A, z, U, s as evaluated";
  if (primal.status != convex::Status::solved)
    return fmt::format(
        "NOT solved to the accuracy that was asked for; {} reached: {}.{}{}\n", primal.method, accuracy,
        mechanics::is_at_rounding(primal) && !primal.is_within(solved.scene.solve.accuracy)
            ? " The tolerance is below the rounding of doubles: ask for a larger one than this."
            : "",
        primal.lambda.allFinite() ? ""
                                  : " A multiplier is beyond what doubles hold: other units bring it back.");
  return fmt::format("Solved{}{}: {}.\n",
                     solved.verbose || solved.asked_method ? " by " + methods_that_ran(solved) : "",
                     primal.polished ? ", polished" : "", accuracy);
}

namespace {

std::string infeasible_text(const SolvedScene& solved) {
  const convex::Vector& w = solved.solution.primal.farkas;
  std::vector<std::string> parts;
  for (Index row = 0; row < w.size(); ++row) {
    if (w[row] == 0) continue;
    parts.push_back(fmt::format("{} times {}", number_text(w[row]), solved.scene.contact_name(row)));
  }
  return fmt::format(
      "No acceleration satisfies all contacts: in the sum of\n  {}\nthe accelerations cancel, and what is "
      "left reads 0 >= {} (Farkas).{}\n",
      listed(parts), number_text(left_of_contradiction(solved)),
      !is_proved(solved.certificate)                           ? ""
      : solved.certificate->level == convex::ProofLevel::exact ? " Proved in fractions."
                                                               : " Proved with bounds on every rounding.");
}

}  // namespace

std::string solve_text(const SolvedScene& solved) {
  const std::string text = heading(solved.scene.title, solved.scene.file);
  if (solved.infeasible()) return text + infeasible_text(solved) + from_text_text(solved);
  if (!solved.has_answer())
    return text + fmt::format("The method {} found neither a solution nor a proof that there is none.\n",
                              solved.solution.primal.method);
  const ReadableNumbers read = readable_numbers(solved, most_rows);
  const bool tells_how = solved.verbose || solved.solution.primal.status != convex::Status::solved;
  const bool tells_hypothesis = solved.verbose || !solved.solution.hypothesis.accepted;
  return text + verdict_line(solved) + constraint_table(solved, read) + coordinate_table(solved, read) +
         added_rows_text(solved) + touching_text(solved) + uniqueness_text(solved, read) +
         (tells_hypothesis ? hypothesis_text(solved) : "") + (tells_how ? model_text(solved) : "") +
         left_open_text(solved) + dual_text(solved) + accuracy_text(solved) + from_text_text(solved) +
         fractions_text(solved) + sensitivity_text(solved);
}

}  // namespace cli::inline reports
