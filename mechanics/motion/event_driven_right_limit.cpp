#include <algorithm>
#include <cmath>
#include <utility>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/leaving_zero.hpp"

/// The right limit of an arc where arguments of branches are 0: the branch of each is the sign with which its
/// argument goes on, which depends on q'' and so on the branches.
namespace mechanics::inline motions {
namespace {

/// An argument that was so many roundings from 0, and is at 0 now, has jumped onto it.
constexpr double jumped = 0x1p26;

/// An argument at 0 is so within so many times what its rounding, and that of the time, leave of it.
constexpr double roundings_at_zero = 4;

/// A series is known at the end of its arc to so many roundings of what it is the sum of.
constexpr double roundings_of_series = 16;

/// What comes to rest has taken longer than so many times the rounding of the time.
constexpr double instants_until_rest = 1e3;

/// A rate that falls to less than this part of itself at an event is that of a rest.
constexpr double part_of_rate = 1e-3;

/// A step ends before an argument that stayed 0 is so many times farther than rounding: it has left by then,
/// and what leaves slowly comes so far in a step.
constexpr double far_from_zero = 2;

/// Of so many arguments at 0 all branches are tried.
constexpr std::size_t most_tried = 8;

}  // namespace

ContactQuestion Motion::EventDriven::question_of(const std::vector<Index>& contacts) const {
  ContactQuestion question{{}, contacts, unloaded_};
  for (Index a = 0; a < expansion_.constraints(); ++a)
    if (is_two_sided(a)) question.held.push_back(a);
  return question;
}

/// What an argument is the sum of on an arc, up to a time.
double Motion::EventDriven::terms_of_argument(std::size_t k, double tau) const {
  if (watched_.size() < expansion_.switches()) return 0;
  double terms = 0;
  const std::vector<double>& c = watched_[watched_.size() - expansion_.switches() + k].c;
  for (std::size_t i = c.size(); i-- > 0;) terms = terms * tau + std::abs(c[i]);
  return terms * std::pow(tau, watched_[watched_.size() - expansion_.switches() + k].zeros);
}

/// The rate of an argument on an arc, at a time, without its sign.
double Motion::EventDriven::rate_of_argument(std::size_t k, double tau) const {
  if (watched_.size() < expansion_.switches() || !(tau > 0)) return 0;
  const Watched& one = watched_[watched_.size() - expansion_.switches() + k];
  const double rate =
      std::pow(tau, one.zeros) * (slope_at(one.c, tau) + one.zeros * value_at(one.c, tau) / tau);
  return std::isfinite(rate) ? std::abs(rate) : 0;  // near where a derivative has no bound, nothing is known
}

/// Whether an argument is 0 at the end of the arc, as far as its series there tells.
bool Motion::EventDriven::is_at_zero_of_arc(std::size_t k) const {
  return std::abs(expansion_.switch_argument(k)[0]) <=
         roundings_of_series * epsilon * terms_of_argument(k, done.length);
}

/// What rounding may have made, up to a time of the next arc, of an argument that stays 0: by its first two
/// derivatives, with which the rounding of forces enters; majorants of higher ones do not converge for as
/// long.
double Motion::EventDriven::left_of_argument(std::size_t k, double tau) {
  const Argument& argument = arguments_[k];
  double left = 0;
  for (std::size_t j = argument.rounding_of_zero.size(); j-- > 1;)
    left = (left + argument.rounding_of_zero[j]) * tau;
  return argument.left_of_zero + (std::isfinite(left) ? left : 0);
}

/// Whether an argument that stayed 0 is so many times farther than what rounding may have made of it, at a
/// time of the next arc.
bool Motion::EventDriven::has_left_zero(std::size_t k, double tau, double times) {
  return expansion_.branch(k) == 0 &&
         std::abs(expansion_.switch_argument(k)[0]) >
             times * (left_of_argument(k, tau) + expansion_.rounding_of_argument(k));
}

/// q'' and the multipliers at a time of the next arc, by the text: on the branches that the arguments which
/// have left 0 take by then. Nothing where they are not defined there.
std::optional<HeldRows::Answer> Motion::EventDriven::acceleration_off_zero(double tau) {
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < expansion_.switches(); ++k)
    if (has_left_zero(k, tau, far_from_zero)) left.push_back(k);
  if (left.empty()) return expansion_.acceleration(counted_);
  const std::optional<HeldRows::Answer> answer = acceleration_off_zero(there_, left, tau);
  expansion_.set(there_);
  return answer;
}

/// The same at a state, on the branches that these arguments take there.
std::optional<HeldRows::Answer> Motion::EventDriven::acceleration_off_zero(
    const State& there, const std::vector<std::size_t>& left, double tau) {
  std::optional<HeldRows::Answer> answer;
  std::vector<double> before;
  for (const std::size_t k : left) before.push_back(expansion_.branch(k));
  try {
    expansion_.set(there);
    for (const std::size_t k : left)
      if (const double argument = expansion_.switch_argument(k)[0]; argument != 0)
        expansion_.branch(k) = std::copysign(1.0, argument);
    expansion_.set(there);
    answer = expansion_.acceleration(counted_);
    note_across(tau);
  } catch (const convex::InvalidInput& error) {
    obstacle_ = error.what();
  }
  for (std::size_t i = 0; i < left.size(); ++i) expansion_.branch(left[i]) = before[i];
  return answer;
}

/// What stayed 0 on the arc behind and does not go on so: arguments of branches, and contacts without a
/// multiplier that would have to pull. Of an argument that no rounding moves the derivatives tell it too.
std::vector<Zero> Motion::EventDriven::left_behind() {
  std::vector<Zero> found;
  std::vector<Index> unmoved;
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    if (expansion_.branch(k) != 0) continue;
    const auto which = static_cast<Index>(k);
    const bool has_left = has_left_zero(k, done.length, 1);
    arguments_[k].left_of_zero = left_of_argument(k, done.length);
    if (has_left)
      found.push_back({Zero::Of::branch, which, done.length});
    else if (arguments_[k].left_of_zero == 0)
      unmoved.push_back(which);
  }
  const auto roundings = expansion_.rounding_of_switches(unmoved, expansion_.order() - 1);
  for (std::size_t i = 0; i < unmoved.size(); ++i)
    if (sign_ahead(static_cast<std::size_t>(unmoved[i]), roundings[i]).value_or(0) != 0)
      found.push_back({Zero::Of::branch, unmoved[i], done.length});
  for (const Index a : persist_) {
    const auto k = static_cast<std::size_t>(a);
    if (is_weak_[k] && expansion_.multiplier(a)[0] < -room_of_weak * least_multiplier_[k])
      found.push_back({Zero::Of::multiplier, a, done.length});
  }
  come_to_rest(found);
  return found;
}

/// The sign with which an argument at 0 goes on: of the first derivative that is not 0 but for rounding; 0 if
/// there is none. Each order has its own scale: derivatives of a fast motion grow with their order. A zero of
/// higher order is met a little beside: it goes on with the sign with which it comes first to what is left of
/// it there. Nothing where the series does not tell it.
std::optional<double> Motion::EventDriven::sign_ahead(std::size_t k, std::vector<double> by_rounding) {
  const std::span<const double> c = expansion_.switch_argument(k).first(expansion_.known_of_argument(k));
  if (std::isnan(c[0])) return expansion_.branch(k);  // not asked on these branches
  Argument& argument = arguments_[k];
  if (argument.jumps && c[0] != 0) return std::copysign(1.0, c[0]);
  // A velocity that comes to 0 has the rounding of what it was.
  if (record.steps > 0 && done.length > 0 && by_rounding.size() > 1)
    by_rounding[1] =
        std::max(by_rounding[1], roundings_of_series * epsilon * argument.terms_behind / done.length);
  // One that contains others at 0 may have jumped off it with them: it is farther than the time of the event
  // is uncertain.
  const double moment = record.steps == 0 ? 0 : rounding_of_time(0);
  double terms = 0;
  for (std::size_t i = c.size(); i-- > 1;) terms = (terms + std::abs(c[i])) * moment;
  const double farthest =
      roundings_at_zero * (by_rounding[0] + std::max(terms, argument.rate_behind * moment));
  argument.width_of_zero = std::max(argument.left_of_zero, std::isfinite(farthest) ? farthest : 0);
  std::size_t first = std::abs(c[0]) > argument.width_of_zero ? 0 : 1;
  while (first < c.size() && !(std::abs(c[first]) > by_rounding[first])) {
    if (std::isnan(c[first])) throw convex::InvalidInput("an argument of a branch has no derivative there");
    ++first;
  }
  if (record.steps > 0 && first > 0 && first < c.size() && farthest > 0) {
    const std::size_t seen = first == 1 && argument.crosses && !by_single_terms_ ? 2 : c.size();
    const LeavingTerm leaving = leaving_term(c, by_rounding, first, farthest);
    first = leaving_term(c.first(seen), by_rounding, first, farthest, by_single_terms_).order;
    // What is left of a rest, c_0 or c_1, moves on by itself, and stays within that for as long as it took to
    // come here, from farther, and for as long as the motion takes to change: a force that has just begun to
    // push is small yet, and leads away sooner.
    const bool is_left = (c[0] != 0 || c[1] != 0) && argument.terms_behind > farthest;
    if (is_left && since_event_ > instants_until_rest * moment && leaving.at > since_event_ &&
        leaving.at > length_ahead())
      first = c.size();
  }
  argument.zeros = static_cast<int>(std::min(first, c.size()));
  if (first < c.size()) return std::copysign(1.0, c[first]);
  return c.size() < expansion_.switch_argument(k).size() ? std::nullopt : std::optional(0.0);
}

/// The branches of the others where these jump, and with them an argument such as that of sign(if(x < 0, y,
/// 1)). What is at 0 then, or jumps onto it, is in question as these are.
void Motion::EventDriven::follow_jumps(std::vector<Index>& at_zero, const std::vector<double>& before) {
  const auto set = [this] {
    expansion_.set(state);
    expansion_.take_bases_for_zero();
  };
  // Past a pole the text alone tells the sides, whatever rounding makes of numbers so large.
  const bool is_jump =
      std::any_of(arguments_.begin(), arguments_.end(), [](const Argument& one) { return one.jumps; });
  set();
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    if (is_among(at_zero, static_cast<Index>(k))) continue;
    const double argument = expansion_.switch_argument(k)[0], rounding = expansion_.rounding_of_argument(k);
    const bool is_large = is_jump && rounding > half_the_digits * arguments_[k].terms_behind,
               is_at_zero = std::abs(argument) <= rounding && !(is_large && argument != 0),
               was_off = !(std::abs(before[k]) <= jumped * rounding);
    const double branch = !is_at_zero ? std::copysign(1.0, argument) : was_off ? 0 : expansion_.branch(k);
    // Where rounding is more than half the digits of what it was on the arc, as near a pole, it is no sign of
    // 0.
    if (is_at_zero && (was_off || argument == 0 || rounding <= half_the_digits * arguments_[k].terms_behind))
      at_zero.push_back(static_cast<Index>(k));
    if (branch == expansion_.branch(k)) continue;
    expansion_.branch(k) = branch;
    set();
  }
}

/// The right limit on the branches that it itself takes. First are those of the text at a start, where
/// sign(0) = 0, and at an event those across of what crosses 0, those of before of what touches it; then the
/// signs with which the arguments go on from there, as long as they are new; 0 for those that turn back and
/// forth; then all others, 0 for those that were seen to stay. An argument that stays 0 has the branch 0;
/// only where none is found so, that beside it.
std::optional<ContactAnswer> Motion::EventDriven::answer_on_branches(const std::vector<Index>& contacts,
                                                                     std::vector<Index>& at_zero) {
  const ContactQuestion question = question_of(contacts);
  undefined_beyond_.clear();
  if (at_zero.empty()) {
    expansion_.set(state);
    return expansion_.expand(question);
  }
  using Branches = std::vector<double>;
  const std::size_t switches = expansion_.switches(), asked = at_zero.size();
  const bool begins = record.steps == 0;
  Branches before, across;
  for (std::size_t k = 0; k < switches; ++k)
    before.push_back(expansion_.switch_argument(k)[0]), across.push_back(expansion_.branch(k));
  for (const Index which : at_zero) {
    const auto k = static_cast<std::size_t>(which);
    if (begins || arguments_[k].crosses) across[k] = begins ? (before[k] > 0) - (before[k] < 0) : -across[k];
  }
  enum class Found { nothing, excluded, beside, itself };
  std::optional<ContactAnswer> answer;
  Branches ahead;
  std::vector<bool> may_stay(switches);
  const auto look = [&](const Branches& branches) {
    for (std::size_t k = 0; k < switches; ++k) expansion_.branch(k) = branches[k];
    ahead = branches;
    try {
      follow_jumps(at_zero, before);
      answer = expansion_.expand(question);
      if (!answer->excluding.empty()) return Found::excluded;
      Found found = Found::itself;
      const auto roundings = expansion_.rounding_of_switches(at_zero, expansion_.order() - 1);
      std::vector<Index> untold;
      for (std::size_t i = 0; i < at_zero.size(); ++i) {
        const auto k = static_cast<std::size_t>(at_zero[i]);
        const std::optional<double> sign = sign_ahead(k, roundings[i]);
        ahead[k] = sign.value_or(0);
        if (!sign) untold.push_back(at_zero[i]);
      }
      if (!untold.empty()) take_signs_beside(untold, ahead);
      for (const Index which : at_zero) {
        const auto k = static_cast<std::size_t>(which);
        const double sign = ahead[k];
        if (sign == 0) may_stay[k] = true;
        if (sign != expansion_.branch(k))
          found = sign == 0 && found != Found::nothing ? Found::beside : Found::nothing;
      }
      const bool is_denied = found == Found::beside && is_denied_beside(at_zero, ahead);
      if (found == Found::beside || !untold.empty()) {
        expansion_.set(state);
        expansion_.take_bases_for_zero();
        answer = expansion_.expand(question);
      }
      return is_denied ? Found::nothing : found;
    } catch (const convex::InvalidInput& error) {  // nothing is defined there, as beyond a table's end
      undefined_beyond_ = error.what();
      return Found::nothing;
    }
  };
  Found best = Found::nothing;
  Branches of_best;
  std::vector<std::pair<std::size_t, Branches>> tried;  // with as many in question
  const auto is_new = [&](const Branches& branches) {
    return std::find(tried.begin(), tried.end(), std::pair(at_zero.size(), branches)) == tried.end();
  };
  const auto take = [&](const Branches& branches) {
    tried.emplace_back(at_zero.size(), branches);
    const Found found = look(branches);
    Branches followed;
    for (std::size_t k = 0; k < switches; ++k) followed.push_back(expansion_.branch(k));
    if (found > best) best = found, of_best = followed;
    tried.emplace_back(at_zero.size(), std::move(followed));
  };
  // What crosses 0 does so with its rate; only where no branch goes on so it may have but touched it.
  for (const bool single : {false, true}) {
    if (best == Found::itself) break;
    by_single_terms_ = single;
    tried.clear();
    Branches trial = across;
    for (bool is_first = true; best != Found::itself && (is_first || is_new(trial)); is_first = false) {
      Branches last = trial;
      for (; best != Found::itself && is_new(trial); trial = ahead) take(last = trial);
      for (std::size_t k = 0; k < switches; ++k)  // neither sign goes on, as of a body that comes to rest
        if (trial[k] != last[k]) trial[k] = 0;
    }
  }
  by_single_terms_ = false;
  const std::vector<Index> varied(at_zero.begin(),
                                  at_zero.begin() + static_cast<long>(std::min(at_zero.size(), most_tried)));
  const auto choices = static_cast<std::size_t>(std::pow(3, varied.size()));
  for (std::size_t choice = 0; choice < choices && best != Found::itself; ++choice) {
    Branches branches = across;
    bool may_be = true;
    std::size_t digits = choice;
    for (const Index which : varied) {
      const auto k = static_cast<std::size_t>(which);
      const double first = across[k] == 0 ? 1 : across[k];
      branches[k] = digits % 3 == 0 ? first : digits % 3 == 1 ? -first : 0;
      may_be = may_be && (branches[k] != 0 || may_stay[k]);
      digits /= 3;
    }
    if (may_be && is_new(branches)) take(branches);
  }
  if (best == Found::nothing) return std::nullopt;
  if (best != Found::itself) look(of_best);
  for (const Index which : at_zero) {
    const auto k = static_cast<std::size_t>(which);
    Argument& argument = arguments_[k];
    argument.left_of_zero = argument.width_of_zero;
    const double rate = std::abs(expansion_.switch_argument(k)[1]);
    if (!begins && expansion_.branch(k) == 0 && argument.crosses && rate > 0 &&
        rate >= part_of_rate * argument.rate_behind)
      remark(
          RemarkKind::doubt,
          "an argument of a branch, as x of |x|, comes to 0 with no more than rounding of what it was, and "
          "counts as 0 from there on");
  }
  // What jumped onto 0 on other branches only is not at 0 on these.
  const auto is_off = [&](Index which) {
    const auto k = static_cast<std::size_t>(which);
    return std::abs(expansion_.switch_argument(k)[0]) > expansion_.rounding_of_argument(k);
  };
  at_zero.erase(std::remove_if(at_zero.begin() + static_cast<long>(asked), at_zero.end(), is_off),
                at_zero.end());
  return answer;
}

}  // namespace mechanics::inline motions
