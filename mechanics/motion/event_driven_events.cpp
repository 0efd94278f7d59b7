#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/impact.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

/// Of a speed, what it is the sum of is rounded so often between two impacts: by the impact, and by the arc.
constexpr double roundings_of_speed = 2;

constexpr long most_gains_followed = 10'000;  ///< of impacts that gain energy without bound

std::vector<Index> united(std::vector<Index> a, const std::vector<Index>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

}  // namespace

/// Free contacts that are closed, as far as rounding tells, and closing: an impact of another turned them
/// back before they had left, and no zero lies ahead of them.
std::vector<Zero> Motion::EventDriven::closing_at_once() {
  std::vector<Zero> found;
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (is_two_sided(a) || is_held_[k] || zeros_of_f_[k] > 0 || !(expansion_.rate(a) < 0)) continue;
    if (expansion_.f(a) <= roundings_of_closed * epsilon * expansion_.position_scale(a) &&
        expansion_.rate(a) < -expansion_.rounding_of_rate(a))
      found.push_back({Zero::Of::constraint, a, 0, false});
  }
  return found;
}

/// What comes to 0 at the end of a step, all at once.
void Motion::EventDriven::handle(const std::vector<Zero>& zeros) {
  std::vector<Index> closing, touching, switches, held, lost;
  for (const Index a : persist_)
    if (!is_two_sided(a)) held.push_back(a);
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    arguments_[k].crosses = arguments_[k].jumps = false;
    arguments_[k].terms_behind = terms_of_argument(k, done.length);
    arguments_[k].rate_behind = rate_of_argument(k, done.length);
  }
  for (const Zero& zero : zeros) {
    if (zero.of == Zero::Of::branch) {
      switches.push_back(zero.which);
      arguments_[static_cast<std::size_t>(zero.which)].crosses = !zero.is_touch;
      arguments_[static_cast<std::size_t>(zero.which)].jumps = zero.is_jump;
    }
    if (zero.of != Zero::Of::constraint) continue;
    // Where its gradient vanishes a contact is touched, and d²f/dt² tells whether it opens.
    const bool is_lost = expansion_.has_lost_gradient(zero.which),
               falls = expansion_.rate(zero.which) < -expansion_.rounding_of_rate(zero.which),
               turns = (is_lost || (falls && !zero.is_touch)) && turns_within_rounding(zero.which);
    if (is_lost && !turns) return stop_at_vanishing_gradient(zero.which);
    if (is_lost) lost.push_back(zero.which);
    (falls && !turns && !zero.is_touch && !zero.is_soft ? closing : touching).push_back(zero.which);
    if (zero.is_touch || (turns && !is_lost))
      remark(RemarkKind::touch, constraint_name(zero.which) +
                                    " is touched and left within rounding: data that differ in their last "
                                    "digits make it an impact, or "
                                    "nothing");
  }
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    arguments_[k].branch_behind = expansion_.branch(k);
    if (expansion_.branch(k) != 0) arguments_[k].left_of_zero = 0;
  }
  for (const Zero& zero : zeros)
    if (zero.left > 0) arguments_[static_cast<std::size_t>(zero.which)].left_of_zero = zero.left;
  note_behind();
  std::fill(zeros_of_f_.begin(), zeros_of_f_.end(), 0);
  // Those that stayed 0 may go on otherwise; and where double zeros are one, rounding parts them.
  for (std::size_t k = 0; k < expansion_.switches(); ++k)
    if ((expansion_.branch(k) == 0 || is_at_zero_of_arc(k)) && !is_among(switches, static_cast<Index>(k)))
      switches.push_back(static_cast<Index>(k));
  tell_blur(zeros);
  if (closing.size() > 1) tell_order(zeros, closing);
  if (!closing.empty() && !lost.empty()) return stop_at_vanishing_gradient(lost.front());
  if (!closing.empty()) {  // with all contacts that are closed, those that open included
    for (Index a = 0; a < expansion_.constraints(); ++a)
      if (!is_two_sided(a) && !is_among(closing, a) &&
          std::abs(expansion_.f(a)) <= roundings_of_closed * epsilon * expansion_.position_scale(a))
        touching.push_back(a);
    collide(closing, united(std::move(held), touching), switches);
    return;
  }
  const Vector before = state.v;
  if (switches.empty()) note_unloading(zeros);
  begin_arc(united(held, touching), switches, lost);
  unloaded_.clear();
  if (status != MotionStatus::done) return;
  if (!touching.empty()) event(EventKind::contact, touching, before);
  release_event(held, before);
}

/// Contacts that were held, are still at f = df/dt = 0, and persist no longer.
void Motion::EventDriven::release_event(const std::vector<Index>& held_before,
                                        const Vector& velocity_before) {
  std::vector<Index> released;
  for (const Index a : held_before)
    if (!is_among(persist_, a) && zeros_of_f_[static_cast<std::size_t>(a)] > 1) released.push_back(a);
  if (!released.empty()) event(EventKind::release, released, velocity_before);
}

void Motion::EventDriven::collide(const std::vector<Index>& closing, const std::vector<Index>& touching,
                                  const std::vector<Index>& switches) {
  const Switches before_jump = switches_before_jump(switches);
  std::vector<Index> present = united(closing, touching);
  for (Index a = 0; a < expansion_.constraints(); ++a)
    if (is_two_sided(a) && !is_among(present, a)) present.push_back(a);
  take_rounding_of_gradients_for_zero(present);
  striking_.resize(present.size());
  for (std::size_t k = 0; k < present.size(); ++k) {
    const Index a = present[k];
    // A contact that is held, or touches softly, has no rate but from rounding, of velocities that may be
    // past; at the start one may open, or close within the contact tolerance.
    const double rate = expansion_.rate(a);
    const bool turns = is_among(closing, a), is_free = !is_two_sided(a);
    const bool is_at_rest = switches.empty() && is_among(persist_, a);
    const double told = record.steps == 0 ? std::abs(rate) : rate;
    const bool moves = turns || (is_free && !is_at_rest && told > expansion_.rounding_of_rate(a));
    ImpactContact& contact = striking_[k];
    expansion_.row(a, contact.u);
    contact.rate = moves ? rate : 0;
    contact.restitution = is_free ? options.restitution[a] : 0;
    contact.two_sided = !is_free;
    contact.rate_scale = expansion_.rate_scale(a);
    if (turns && !is_free && options.impact_law == ImpactLaw::sequential)
      return stop("at t = " + number_text(state.t) + ": " + constraint_name(a) +
                  " has a kink, of which impacts one after the other say nothing; take impact_law = "
                  "\"moreau\"");
  }
  const convex::Metric& A = expansion_.inertia();
  Vector before = state.v;
  if (!record.first_impact)
    record.first_impact = ImpactScene{
        state.t, A,        before, system.kinetic_energy(state), expansion_.momentum() - A.multiply(before),
        present, striking_};
  const ImpactOutcome outcome = impact(A, striking_, options.impact_law);
  if (!outcome.undetermined.empty())
    return stop("at t = " + number_text(state.t) + ": " + std::string(outcome.undetermined));
  if (!outcome.remark.empty()) remark(RemarkKind::impact_law, std::string(outcome.remark));
  for (const Index k : outcome.excluding)
    if (const Index a = present[static_cast<std::size_t>(k)]; expansion_.is_singular(a))
      return stop_at_vanishing_gradient(a);
  std::vector<Index> excluded;
  for (const Index k : outcome.excluding) excluded.push_back(present[static_cast<std::size_t>(k)]);
  if (!excluded.empty() && may_stop_in_time(excluded, outcome.weights)) {
    brought_to_rest(present);
    return begin_arc(present, branches_after_jump(before_jump));
  }
  if (!excluded.empty()) {
    status = MotionStatus::infeasible;
    excluding = std::move(excluded);
    why = "at t = " + number_text(state.t) + ": no velocity after the impact satisfies all contacts";
    return;
  }
  // T+ - T- = (v+ - v-)·(p + A (v+ - v-)/2), and b·(v+ - v-) with b = p - A v-
  const Vector thrust = A.multiply(outcome.change);
  const double by_momentum = expansion_.momentum_along(outcome.change);
  record.impact_energy += by_momentum + 0.5 * outcome.change.dot(thrust);
  record.ledger_energy += by_momentum - before.dot(thrust);
  state.v = before + outcome.change;
  std::vector<Index> hit, resting, held;
  std::optional<double> end_of_gain;
  for (std::size_t k = 0; k < present.size(); ++k) {
    const Index a = present[k], at = static_cast<Index>(k);
    const double rate_before = striking_[k].rate, e = rate_before > 0 ? 0 : striking_[k].restitution;
    // By Moreau's law f'(v+) = -e f'(v-) wherever P is not 0.
    const double rate_after = options.impact_law == ImpactLaw::moreau ? -e * rate_before : outcome.rate[at];
    record.ledger_energy += outcome.impulse[at] * (0.5 * (rate_before + rate_after) - expansion_.drift(a));
    if (is_two_sided(a) && is_among(closing, a)) hit.push_back(a);
    if (is_two_sided(a)) continue;
    if (is_among(persist_, a)) held.push_back(a);
    if (rate_before < 0 || outcome.impulse[at] > 0) hit.push_back(a);
    if (!(outcome.rate[at] > 0)) resting.push_back(a);
    ImpactHistory& history = history_[static_cast<std::size_t>(a)];
    if (rate_before < 0) {
      history.add(elapsed_[static_cast<std::size_t>(a)], -rate_before, since_start_ + low_,
                  epsilon * elapsed_[static_cast<std::size_t>(a)] + rounding_of_f(a) / -rate_before,
                  roundings_of_speed * epsilon *
                      std::max(-rate_before, expansion_.uses_time() ? expansion_.magnitude_of_rate(a)
                                                                    : striking_[k].rate_scale));
      history.note_bounce(bounce_over_rounding(a, -rate_before, history));
      elapsed_[static_cast<std::size_t>(a)] = 0;
      if (history.count() >= most_gains_followed && !end_of_gain) end_of_gain = history.end_of_gain();
    }
  }
  event(EventKind::impact, std::move(hit), std::move(before));
  if (end_of_gain && start_ + *end_of_gain < until_ &&
      record.impact_energy > 0.5 * system.kinetic_energy(state))
    return stop(
        "at t = " + number_text(state.t) + ": after " + std::to_string(record.impacts) +
        " impacts, which gain energy ever faster, these come to their end by t = " +
        number_text(start_ + *end_of_gain) +
        " with a speed beyond all bounds, as of a body that walls close in on; give an end before it");
  const auto take_note_of_leaving = [&] {
    for (std::size_t k = 0; k < present.size(); ++k)
      if (!is_two_sided(present[k]) && outcome.rate[static_cast<Index>(k)] > 0)
        zeros_of_f_[static_cast<std::size_t>(present[k])] = 1;
  };
  take_note_of_leaving();
  std::vector<Index> after = branches_after_jump(before_jump);
  const std::vector<Index> ending = accumulating(closing);
  if (!ending.empty()) {
    const Vector bouncing = state.v;
    const std::vector<Index> stopping = brought_to_rest(united(resting, ending));
    const ImpactHistory last = history_[static_cast<std::size_t>(ending.front())];
    begin_arc(stopping, branches_after_jump(before_jump));
    const bool rest = status == MotionStatus::done && std::all_of(ending.begin(), ending.end(), [&](Index a) {
                        return is_among(persist_, a);
                      });
    if (rest) {
      for (const Index a : ending) history_[static_cast<std::size_t>(a)].forget();
      const double now = since_start_ + low_,
                   end = time_stands_still() || !last.shrinks() ? now : std::max(now, last.end());
      endings.push_back({start_ + end, ending});
      std::sort(endings.begin(), endings.end(), [](const Ending& x, const Ending& y) { return x.t < y.t; });
      if (time_stands_still()) return;
      // The last impacts may have come, by rounding, after the end that the surer ones before them tell.
      const double error = last.end_error() + (end - last.end());
      if (last.next_height() > options.tolerance || error > options.tolerance * end)
        remark(RemarkKind::accumulation,
               "impacts of " + constraint_name(ending.front()) +
                   " that bounce up to f = " + number_text(last.next_height()) +
                   " are not followed one by one; they end at t = " + number_text(start_ + end) +
                   (std::isfinite(error)
                        ? " within " + number_text(std::max(error, epsilon * std::abs(start_ + end)))
                        : " or so: too few came for a bound"),
               error);
      return;
    }
    if (status != MotionStatus::done) return;
    state.v = bouncing;
    std::fill(zeros_of_f_.begin(), zeros_of_f_.end(), 0);  // what was tried tells nothing of what opens
    take_note_of_leaving();
    after = branches_after_jump(before_jump);
  }
  // Beside a kink the side that a contact leaves to may not let it go.
  std::vector<Index> leaving;
  for (std::size_t k = 0; k < present.size(); ++k)
    if (!is_two_sided(present[k]) && !is_among(resting, present[k])) leaving.push_back(present[k]);
  begin_arc(united(resting, with_kinks(leaving, after)), after);
  if (status == MotionStatus::done) release_event(held, state.v);
}

void Motion::EventDriven::begin_arc(const std::vector<Index>& contacts, std::vector<Index> switches,
                                    const std::vector<Index>& without_gradient) {
  std::fill(zeros_of_lambda_.begin(), zeros_of_lambda_.end(), 0);
  for (Argument& one : arguments_) one.zeros = 0;
  std::fill(is_weak_.begin(), is_weak_.end(), false);
  take_rounding_of_gradients_for_zero(contacts);
  if (expansion_.has_open_angle())
    return stop(
        "at t = " + number_text(state.t) +
        ": both arguments of an atan2 are 0, and nothing tells the angle there; write the expressions "
        "without it, or begin beside that place");
  std::optional<ContactAnswer> answer = answer_on_branches(contacts, switches);
  if (answer && record.steps == 0 && take_sides_of_start(switches))
    answer = answer_on_branches(contacts, switches);
  if (answer && meet_kinks(contacts, switches)) return;
  if (!answer) {
    const std::string obstacle = "at t = " + number_text(state.t) + ": " + obstacle_ahead(contacts, switches);
    if (until_ - state.t > roundings_of_closed * epsilon * clock()) return stop(obstacle);
    ends_here_ = obstacle;  // asked for no more
    state.t = until_;
    acceleration = done.acceleration(done.length);
    multipliers = done.multipliers(done.length);
    return;
  }
  for (const Index a : answer->excluding)
    if (expansion_.is_singular(a)) return stop_at_vanishing_gradient(a);
  for (const Index a : answer->persist)
    if (is_among(without_gradient, a) || (is_two_sided(a) && expansion_.is_singular(a)))
      return stop_at_vanishing_gradient(a);
  if (!answer->excluding.empty()) {
    status = MotionStatus::infeasible;
    excluding = answer->excluding;
    why = "at t = " + number_text(state.t) + ": no acceleration satisfies all contacts";
    return;
  }
  for (const Index a : expansion_.in_doubt())
    remark(RemarkKind::doubt,
           "whether " + constraint_name(a) +
               " stays closed hangs on a number so small beside its terms that rounding may have made it, or "
               "hidden it");
  keep_unseen(*answer);
  persist_ = answer->persist;
  for (const auto& [a, order] : answer->open) zeros_of_f_[static_cast<std::size_t>(a)] = order;
  for (const Index a : persist_) {
    const auto k = static_cast<std::size_t>(a);
    const std::span<const double> lambda = expansion_.multiplier(a);
    std::size_t zeros = 0;
    while (zeros < lambda.size() && lambda[zeros] == 0) ++zeros;
    is_weak_[k] = zeros == lambda.size();
    zeros_of_lambda_[k] = is_weak_[k] ? 0 : static_cast<int>(zeros);
  }
  if (std::find(is_weak_.begin(), is_weak_.end(), true) != is_weak_.end()) {
    const Vector least = expansion_.rounding_of_multipliers(persist_);
    for (std::size_t k = 0; k < persist_.size(); ++k)
      least_multiplier_[static_cast<std::size_t>(persist_[k])] = least[static_cast<Index>(k)];
  }
  counted_ = persist_;
  if (!persist_.empty()) {
    const State unprojected = state;
    const std::size_t held = persist_.size();
    project();
    if (status != MotionStatus::done) return;
    if (persist_.size() != held || state.q != unprojected.q || state.v != unprojected.v)
      expansion_.expand({persist_, {}});
  }
  fill_next();
  if (leads_from_pole())
    return stop(
        "at t = " + number_text(state.t) +
        ": a force has a pole there; what it does to the velocity has no bound, or hangs on digits that "
        "t does not have");
  since_event_ = 0;
  bool changed = false;
  for (const Index which : switches) {
    const auto k = static_cast<std::size_t>(which);
    changed = changed || arguments_[k].branch_behind != expansion_.branch(k);
  }
  if (changed && done.length > 0) event(EventKind::branch, {}, state.v);
}

}  // namespace mechanics::inline motions
