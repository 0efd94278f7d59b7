#include <algorithm>
#include <cmath>

#include "mechanics/motion/event_driven.hpp"

namespace mechanics::inline motions {
namespace {

/// Bounces lower than so many roundings of f come at times that rounding decides.
constexpr double roundings_of_bounce = 64;

/// Impacts of one contact that are followed one by one, however high they bounce, where the intervals of all
/// of them shrink by a ratio so steady that the time left is known to a hundredth.
constexpr long most_impacts_followed = 100'000;
constexpr double known_remainder = 0.01;

/// So many steps without an impact, of so few roundings of the time since the start each, lead nowhere.
constexpr long steps_looked_at = 1000;
constexpr double roundings_of_step = 4;

/// So many steps within such a part of the time since the start come to no end: a body that rattles in a
/// groove by what rounding leaves of its velocity.
constexpr long steps_crowded = 100'000;
constexpr double part_of_crowd = 1e-7;

/// Two such crowds that took the same time but for this part go on evenly, as a body does that a relay draws
/// back over and over: where the end asked for is so many times farther than the limit of steps leads, no
/// crowd more is followed.
constexpr double even_part = 1e-3;
constexpr double times_too_far = 100;

/// Where forces change by less than this part in so many steps, what limits the steps is no change of the
/// motion. A velocity that only comes by 0 so slows it down for less than so many times as long.
constexpr long steps_of_stretch = 10'000;
constexpr double unchanged_part = 0.1;
constexpr int most_stretches = 20;

}  // namespace

void Motion::EventDriven::stop_at_vanishing_gradient(Index a) {
  if (is_two_sided(a))
    return stop("at t = " + number_text(state.t) + ": the gradient of " + constraint_name(a) +
                " vanishes here" + std::string(advice_on_singular_states));
  stop("at t = " + number_text(state.t) + ": the gradient of " + constraint_name(a) +
       " vanishes here, and derivatives do not tell what it demands; write it so that its gradient does not "
       "vanish, as y >= 0 for y^3 >= 0");
}

void Motion::EventDriven::stop_at_dependent_rows() {
  stop("at t = " + number_text(state.t) +
       ": the contacts held cannot be brought back to f = 0; they depend on each other at this state" +
       std::string(advice_on_singular_states));
}

/// Whether contacts that exclude each other at an impact do so by no more than rounding tells. With weights
/// w, Σ w_a u_a = 0, the sum of w_a f_a is, whatever the bodies do, how far apart the walls are; they close
/// in at the speed c = -Σ w_a ∂f_a/∂t. Walls that close in ever slower come to rest before they meet if c² is
/// at most twice how they slow down times what rounding leaves of the gap. Walls that do not close in exclude
/// v+ by restitution alone, or by rates that are rounding.
bool Motion::EventDriven::may_stop_in_time(const std::vector<Index>& contacts,
                                           const std::vector<double>& weights) {
  const Vector second = -system.contact_rows(state, contacts).s;
  double closing = 0, slowing = 0, gap = 0, asked = 0, rounding = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Index a = contacts[k];
    const double w = weights[k], size = std::abs(w), rate = expansion_.rate(a);
    const bool rebounds = options.impact_law == ImpactLaw::moreau && !is_two_sided(a) && rate < 0;
    const double e = rebounds ? options.restitution[a] : 0;
    closing -= w * expansion_.drift(a);
    asked -= w * (1 + e) * rate;
    slowing += w * second[static_cast<Index>(k)];
    gap += size * roundings_of_closed * epsilon * expansion_.position_scale(a);
    rounding += size * expansion_.rounding_of_rate(a);
  }
  return closing > rounding ? closing * closing <= 2 * slowing * gap : asked <= rounding;
}

/// The least change of velocity after which contacts are at rest; of walls that close in not both are.
std::vector<Index> Motion::EventDriven::brought_to_rest(std::vector<Index> contacts) {
  constexpr double at_rest = 1e-3;  // of the fastest of them
  Vector rates(static_cast<Index>(contacts.size())), u;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    rates[static_cast<Index>(k)] = expansion_.rate(contacts[k]);
  const Vector change = expansion_.held_rows(contacts).least_change(-rates);
  const double fastest = rates.cwiseAbs().maxCoeff();
  std::erase_if(contacts, [&](Index a) {
    expansion_.row(a, u);
    return std::abs(expansion_.rate(a) + u.dot(change)) > at_rest * fastest + expansion_.rounding_of_rate(a);
  });
  state.v += change;
  for (const Index a : contacts) zeros_of_f_[static_cast<std::size_t>(a)] = 0;  // none of them leaves
  return contacts;
}

/// How high the bounce of a contact was that strikes so fast, by the time it took and by the forces there are
/// to turn it back, in f that rounding leaves open. In a groove of one constraint a body strikes its sides
/// within rounding, too, but fast.
double Motion::EventDriven::bounce_over_rounding(Index a, double speed, const ImpactHistory& history) const {
  const double pull = expansion_.inertia().dual_norm(expansion_.row(a)) * expansion_.force_norm();
  const double height = std::max(history.next_height(), 0.5 * speed * speed / pull);
  return height / (roundings_of_bounce * epsilon * expansion_.position_scale(a));
}

std::vector<Index> Motion::EventDriven::accumulating(const std::vector<Index>& closing) const {
  std::vector<Index> found;
  const auto is_near_its_end = [&](Index a) {
    const ImpactHistory& history = history_[static_cast<std::size_t>(a)];
    if (!history.shrinks()) return history.is_rounding();
    const double scale = std::max(history.highest(), roundings_of_bounce * expansion_.position_scale(a));
    return history.next_height() <= epsilon * scale || history.remaining() <= epsilon * clock() ||
           (history.shrinking() >= most_impacts_followed && history.slows() &&
            history.end_error() <= known_remainder * history.remaining() &&
            start_ + history.end() + history.end_error() <= until_);
  };
  for (const Index a : closing)
    if (is_near_its_end(a)) found.push_back(a);
  if (found.empty()) return found;
  if (time_stands_still()) {  // with all that struck at this instant
    for (Index a = 0; a < expansion_.constraints(); ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (!is_among(found, a) && !is_two_sided(a) && elapsed_[k] <= roundings_of_bounce * epsilon * clock())
        found.push_back(a);
    }
    return found;
  }
  // Contacts whose impacts alternate with these come to their end at the same time.
  const double remaining = history_[static_cast<std::size_t>(found.front())].remaining();
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    const ImpactHistory& history = history_[static_cast<std::size_t>(a)];
    if (is_among(found, a) || is_two_sided(a)) continue;
    if (!history.shrinks()) {
      if (history.is_rounding() &&
          expansion_.f(a) <= roundings_of_bounce * epsilon * expansion_.position_scale(a))
        found.push_back(a);
      continue;
    }
    const double end = history.remaining() - elapsed_[static_cast<std::size_t>(a)];
    constexpr double alike = 0.05;
    if (std::abs(end - remaining) <= alike * remaining) found.push_back(a);
  }
  return found;
}

/// Stops where steps are so short, though no force changes, that the limit of steps lies before the end: a
/// velocity follows the others at a rate of which explicit steps are the longer ones, as under -√|v| beside a
/// slower one that it is coupled with. Where nothing but its rounding is left of it, its force may be
/// anything.
void Motion::EventDriven::look_for_stiffness() {
  const Vector& force = expansion_.force();
  Stretch& of = stretch_;
  if (of.steps == 0 || of.events != record.events || of.force.size() != force.size()) {
    if (of.events != record.events) of.in_vain = 0, of.took_before = 0;
    of.steps = 0;
    of.is_of_series = true;
    of.events = record.events;
    of.begin = since_start_;
    of.force = force;
    of.largest = of.change = of.velocity = Vector::Zero(force.size());
  }
  of.largest = of.largest.cwiseMax(force.cwiseAbs());
  of.change = of.change.cwiseMax((force - of.force).cwiseAbs());
  of.velocity = of.velocity.cwiseMax(state.v.cwiseAbs());
  if (++of.steps < steps_of_stretch || status != MotionStatus::done) return;
  bool is_still = of.is_of_series;
  for (Index i = 0; i < force.size(); ++i)
    is_still = is_still && (of.change[i] <= unchanged_part * of.largest[i] ||
                            of.velocity[i] <= half_the_digits * expansion_.fastest(i));
  // Each stretch to come is longer than the one before by the same ratio, as these two are, or as long.
  const double took = since_start_ - of.begin, ratio = std::max(1.0, took / of.took_before),
               left = until_ - start_ - since_start_,
               count = static_cast<double>(options.step_limit - record.steps) / steps_of_stretch,
               farthest = took * (ratio > 1 ? (std::pow(ratio, count) - 1) / (ratio - 1) : count);
  if (!is_still || !(of.took_before > 0) || left <= count * took)
    of.in_vain = 0;
  else if (left > farthest)
    ++of.in_vain;
  if (of.in_vain >= most_stretches)
    stop("at t = " + number_text(state.t) + ": " + std::to_string(steps_of_stretch) +
         " steps take no more than " + number_text(took) +
         ", in which no force changes by a tenth; the end asked for is too far for the limit of " +
         std::to_string(options.step_limit) +
         " steps; so it is where a velocity follows the others ever so fast, as under "
         "-sign(x')*sqrt(abs(x')) near x' = 0");
  of.steps = 0;
  of.took_before = is_still ? took : 0;
}

/// Stops where steps, or events, lead nowhere.
void Motion::EventDriven::look_for_progress() {
  look_for_stiffness();
  if (record.impacts != impacts_at_mark_) mark_ = -1;
  if (mark_ < 0 || record.steps - mark_ >= steps_looked_at) {
    const double shortest = static_cast<double>(steps_looked_at) * roundings_of_step * epsilon * since_start_;
    if (status == MotionStatus::done && mark_ >= 0 && since_start_ - time_of_mark_ < shortest)
      stop("at t = " + number_text(state.t) +
           ": steps shorter than the digits of t do not get past; a derivative has no bound there, as that "
           "of asin, acos and sqrt at the end of their range; write the expressions without it");
    mark_ = record.steps, impacts_at_mark_ = record.impacts, time_of_mark_ = since_start_;
  }
  if (record.steps % steps_crowded != 0) return;
  const double took = since_start_ - time_of_crowd_, left = until_ - start_ - since_start_,
               crowds = static_cast<double>(options.step_limit - record.steps) / steps_crowded;
  if (status == MotionStatus::done && took < part_of_crowd * since_start_)
    stop("at t = " + number_text(state.t) + ": " + std::to_string(steps_crowded) +
         " events have come within " + number_text(took) + ", and do not end" + advice_on_kinks());
  const bool is_even = std::abs(took - last_crowd_) <= even_part * took;
  if (status == MotionStatus::done && record.events > events_at_crowd_ && is_even &&
      left > times_too_far * crowds * took)
    stop("at t = " + number_text(state.t) + ": " + std::to_string(steps_crowded) +
         " steps between events that do not end take no more than " + number_text(took) +
         "; the end asked for is too far for the limit of " + std::to_string(options.step_limit) + " steps" +
         advice_on_kinks());
  last_crowd_ = took;
  events_at_crowd_ = record.events;
  time_of_crowd_ = since_start_;
}

}  // namespace mechanics::inline motions
