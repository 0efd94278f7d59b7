#include "cli/report/verdict_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/report/text_table.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;

std::vector<std::string> contact_names(const SolvedScene& solved, const std::vector<Index>& rows) {
  std::vector<std::string> chosen;
  for (Index row : rows) chosen.push_back(solved.scene.contact_name(row));
  return chosen;
}

const char* have(std::size_t count) {
  return count == 1 ? "has a negative multiplier" : "have negative multipliers";
}
const char* them(std::size_t count) { return count == 1 ? "it" : count == 2 ? "both" : "them"; }

std::string with_numbers(const SolvedScene& solved, const convex::Vector& multipliers) {
  std::vector<std::string> parts;
  for (Index row = 0; row < multipliers.size(); ++row)
    parts.push_back(solved.scene.contact_name(row) + " " + number_text(multipliers[row]));
  return listed(parts);
}

/// What goes wrong when the contacts with negative multipliers are dropped: a contact that would be
/// penetrated, or one of those held that would have to pull.
std::string damage(const SolvedScene& solved) {
  const mechanics::Hypothesis& hypothesis = solved.solution.hypothesis;
  if (!hypothesis.drop_negative_acceleration) return "leave equations that contradict each other";
  const convex::Vector rates =
      solved.scene.problem.U.times(*hypothesis.drop_negative_acceleration) - solved.scene.problem.s;
  Index deepest = -1;
  for (Index row : hypothesis.negative)
    if (deepest < 0 || rates[row] < rates[deepest]) deepest = row;
  const auto holds = [&](Index row) {
    const ConstraintState state = solved.state_of_row(row);
    return state == ConstraintState::persists || state == ConstraintState::touches;
  };
  if (deepest >= 0 && rates[deepest] < 0 && holds(deepest))
    return fmt::format("accelerate the system into {} (d²f/dt² = {})", solved.scene.contact_name(deepest),
                       number_text(rates[deepest]));
  std::vector<std::string> pulling;
  for (Index row = 0; row < solved.scene.problem.rows(); ++row)
    if (!std::binary_search(hypothesis.negative.begin(), hypothesis.negative.end(), row) &&
        solved.state_of_row(row) == ConstraintState::opens)
      pulling.push_back(solved.scene.contact_name(row));
  if (!pulling.empty())
    return fmt::format("hold {} by a pull that a one-sided contact cannot give", listed(pulling));
  return "give another acceleration than the true one";
}

std::string rule_text(const SolvedScene& solved) {
  const mechanics::Hypothesis& hypothesis = solved.solution.hypothesis;
  const std::vector<std::string> negative = contact_names(solved, hypothesis.negative);
  std::vector<std::string> open;
  for (std::size_t a = 0; a < solved.states.size(); ++a)
    if (solved.states[a] == ConstraintState::opens) open.push_back(solved.scene.constraints[a]);
  if (*hypothesis.drop_negative_is_right)
    return fmt::format(
        "Here the rule \"drop the contacts with a negative multiplier\" happens to be right: {} {}, and "
        "dropping {} gives the true motion.\n",
        listed(negative), have(negative.size()), them(negative.size()));
  std::string truth = "nothing opens";
  if (open.size() == 1)
    truth = "only " + open[0] + " opens";
  else if (!open.empty())
    truth = (open.size() < negative.size() ? "only "
             : open.size() == 2            ? "both "
                                           : "") +
            listed(open) + " open";
  return fmt::format(
      "The rule \"drop the contacts with a negative multiplier\" is wrong here (Delassus 1917):\n{} {}, but "
      "{}: dropping {} would {}.\n",
      (negative.size() == 1 ? "only " : "") + listed(negative), have(negative.size()), truth,
      negative.size() == 1 ? "it alone" : them(negative.size()), damage(solved));
}

}  // namespace

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  std::string text;
  const std::size_t shown_names = names.size() == most + 1 ? names.size() : std::min(names.size(), most);
  for (std::size_t k = 0; k < shown_names; ++k) {
    const bool last = k + 1 == names.size();
    text += (k == 0 ? "" : last ? " and " : ", ") + names[k];
  }
  if (names.size() > shown_names) text += fmt::format(" and {} more", names.size() - shown_names);
  return text;
}

std::string hypothesis_text(const SolvedScene& solved) {
  const mechanics::Hypothesis& hypothesis = solved.solution.hypothesis;
  if (solved.scene.problem.rows() == 0) return "";
  if (!hypothesis.two_sided.consistent)
    return "The classical hypothesis, that every contact persists, contradicts itself: as equations the "
           "contacts are inconsistent.\n";
  if (hypothesis.accepted) {
    std::string text = "The classical hypothesis, that every contact persists, is accepted.\n";
    if (!hypothesis.negative.empty())
      text += fmt::format(
          "(Of least norm, the multiplier of {} would be negative; others, all >= 0, give the same "
          "reaction.)\n",
          listed(contact_names(solved, hypothesis.negative)));
    return text;
  }
  std::string text =
      fmt::format("If every contact persisted (the classical hypothesis), lambda would be {}: rejected.\n",
                  with_numbers(solved, hypothesis.two_sided.multipliers));
  if (hypothesis.drop_negative_is_right)
    text += rule_text(solved);
  else if (solved.solution.primal.status == convex::Status::solved)
    text +=
        "Those multipliers are not unique, so the rule \"drop the negative ones\" has no definite meaning.\n";
  return text;
}

}  // namespace cli::inline reports
