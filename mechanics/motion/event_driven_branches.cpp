#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/motion/event_driven.hpp"

namespace mechanics::inline motions {
namespace {

bool is_among(const std::vector<Index>& all, Index a) {
  return std::find(all.begin(), all.end(), a) != all.end();
}

}  // namespace

/// After a jump of the velocity: the branches by the signs of their arguments now. Returns those that are at
/// 0: of what the impact did not move those that were, of what it did those that it left at 0.
std::vector<Index> Motion::EventDriven::branches_after_jump(const std::vector<double>& arguments_before,
                                                            const std::vector<Index>& at_zero_before) {
  constexpr double left_by_rounding = 64 * std::numeric_limits<double>::epsilon();
  expansion_.set(state);
  std::vector<Index> at_zero = find_branches();
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    const double now = expansion_.switch_argument(k)[0], then = arguments_before[k];
    const bool stays = now == then && is_among(at_zero_before, static_cast<Index>(k));
    const bool comes = now != then && std::abs(now) <= left_by_rounding * std::abs(then);
    if (now != 0 && (stays || comes)) at_zero.push_back(static_cast<Index>(k));
  }
  return at_zero;
}

/// The branch of every switch by the sign of its argument; returns those whose argument is 0.
std::vector<Index> Motion::EventDriven::find_branches() {
  std::vector<Index> at_zero;
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {  // an argument may contain the switches before it
    const double argument = expansion_.switch_argument(k)[0], branch = argument > 0 ? 1 : -1;
    if (argument == 0) at_zero.push_back(static_cast<Index>(k));
    if (argument == 0 || branch == expansion_.branch(k)) continue;
    expansion_.branch(k) = branch;
    expansion_.set(state);
  }
  return at_zero;
}

/// Whether each argument at 0 goes on with the sign of its branch: by the first derivative that is not 0 but
/// for rounding. Each order has its own scale: derivatives of a fast motion grow with their order.
bool Motion::EventDriven::is_consistent(const std::vector<Index>& switches) {
  for (const Index which : switches) {
    const auto k = static_cast<std::size_t>(which);
    const std::span<const double> c = expansion_.switch_argument(k);
    const std::vector<double> by_rounding = expansion_.rounding_of_switch(k);
    std::size_t first = 1;
    while (first < c.size() && !(std::abs(c[first]) > by_rounding[first])) ++first;
    if (first < c.size() && !(c[first] * expansion_.branch(k) > 0)) return false;
    zeros_of_switch_[k] = static_cast<int>(std::min(first, c.size()));
  }
  return true;
}

/// Arguments that stay 0 on the arc: what contains them has its value at 0, sign(0) = 0, if it goes on so;
/// else the answer with the branches beside it.
std::optional<ContactAnswer> Motion::EventDriven::answer_where_zero_stays(const ContactQuestion& question,
                                                                          const std::vector<Index>& switches,
                                                                          ContactAnswer beside) {
  const auto stays = [&](Index k) {
    const auto at = static_cast<std::size_t>(k);
    return zeros_of_switch_[at] == static_cast<int>(expansion_.switch_argument(at).size());
  };
  std::vector<Index> zeros;
  std::vector<double> branches;
  for (const Index k : switches)
    if (stays(k)) {
      zeros.push_back(k);
      branches.push_back(expansion_.branch(static_cast<std::size_t>(k)));
      expansion_.branch(static_cast<std::size_t>(k)) = 0;
    }
  if (zeros.empty()) return beside;
  expansion_.set(state);
  ContactAnswer answer = expansion_.expand(question);
  if (answer.excluding.empty() && is_consistent(switches) && std::all_of(zeros.begin(), zeros.end(), stays))
    return answer;
  for (std::size_t j = 0; j < zeros.size(); ++j)
    expansion_.branch(static_cast<std::size_t>(zeros[j])) = branches[j];
  expansion_.set(state);
  beside = expansion_.expand(question);
  if (!is_consistent(switches)) return std::nullopt;
  return beside;
}

/// The right limit on the branches that it itself takes: those across first, then all others.
std::optional<ContactAnswer> Motion::EventDriven::answer_on_branches(const std::vector<Index>& contacts,
                                                                     const std::vector<Index>& switches) {
  ContactQuestion question{{}, contacts};
  for (Index a = 0; a < expansion_.constraints(); ++a)
    if (is_two_sided(a)) question.held.push_back(a);
  constexpr std::size_t most_tried = 8;
  const std::size_t tried = std::min(switches.size(), most_tried);
  for (const Index k : switches)
    if (double& branch = expansion_.branch(static_cast<std::size_t>(k)); branch == 0) branch = 1;
  for (std::size_t choice = 0; choice < (std::size_t{1} << tried); ++choice) {
    for (std::size_t j = 0; j < switches.size(); ++j) {
      double& branch = expansion_.branch(static_cast<std::size_t>(switches[j]));
      // Counting in Gray's order changes one branch at a time.
      if (choice == 0 || (j < tried && ((choice ^ (choice >> 1U)) ^ ((choice - 1) ^ ((choice - 1) >> 1U))) ==
                                           (std::size_t{1} << j)))
        branch = -branch;
    }
    try {
      if (!switches.empty()) expansion_.set(state);
      ContactAnswer answer = expansion_.expand(question);
      if (!answer.excluding.empty()) return answer;
      if (is_consistent(switches)) return answer_where_zero_stays(question, switches, std::move(answer));
    } catch (
        const convex::InvalidInput&) {  // a branch beyond which nothing is defined, such as a table's end
      if (switches.empty()) throw;
    }
  }
  return std::nullopt;
}

}  // namespace mechanics::inline motions
