#include "mechanics/motion/event_driven.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/motion/impact.hpp"
#include "mechanics/motion/polynomial_root.hpp"
#include "mechanics/motion/step_length.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

/// Times since the start within so many roundings of each other are one: several events at once.
constexpr double roundings_of_time = 64;

/// So many roundings of t itself enter the zero of an expression with t in it.
constexpr double roundings_of_t = 8;

/// f counts as 0 in an event of other contacts within so many roundings of what it is the sum of.
constexpr double roundings_of_f = 16;

/// A step is halved so often at most: at a start at t = 0 no rounding of the time ends that.
constexpr int most_halvings = 200;

/// So many events at one instant, for each constraint, have no end.
constexpr long most_events_at_once = 50;

}  // namespace

Motion::EventDriven::EventDriven(const LagrangianSystem& of, const State& at, MotionOptions chosen)
    : Course(of, std::move(chosen)),
      expansion_(of, taylor_order(tolerance_of_step(options.tolerance))),
      reach_(reach_of_argument(expansion_.order(), tolerance_of_step(options.tolerance))) {
  const auto m = system.constraints().size();
  zeros_of_f_.assign(m, 0);
  zeros_of_lambda_.assign(m, 0);
  arguments_.resize(expansion_.switches());
  is_weak_.assign(m, false);
  least_multiplier_.assign(m, 0.0);
  is_blurred_.assign(m, false);
  elapsed_.assign(m, 0.0);
  history_.resize(m);
  begin(at);
}

void Motion::EventDriven::begin(const State& at) {
  state = at;
  start_ = at.t;
  Contacts found = contacts(system, state, options.contact_tolerance, Impending::allowed);
  const auto left_by_rounding = [&](Index a) { return roundings_of_f * epsilon * found.rates.f_scale[a]; };
  done.t = state.t;
  done.q = state.q;
  expansion_.note_reach(state);
  expansion_.set(state);
  std::vector<Index> switches = find_branches();
  for (std::size_t k = 0; k < expansion_.switches(); ++k)
    if (const double argument = std::abs(expansion_.switch_argument(k)[0]);
        argument > 0 && argument <= expansion_.rounding_of_argument(k))
      switches.push_back(static_cast<Index>(k));
  if (!switches.empty()) take_sides_ahead(found, switches);
  // What is above 0 by more than rounding and falls closes when it comes there.
  std::erase_if(found.closing, [&](Index a) { return found.rates.f[a] > left_by_rounding(a); });
  std::vector<Index> touching;
  for (const Index a : found.present) {
    if (!is_two_sided(a)) {
      touching.push_back(a);
      if (std::abs(found.rates.f[a]) > left_by_rounding(a))
        remark(RemarkKind::start,
               constraint_name(a) + ": f = " + number_text(found.rates.f[a]) +
                   " at the start counts as 0, within the contact tolerance",
               std::abs(found.rates.f[a]));
    }
  }
  std::vector<Index> opening;  // f = 0 and df/dt > 0
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    if (is_two_sided(a) || found.rates.f[a] > options.contact_tolerance[a] * found.rates.f_scale[a]) continue;
    if (found.rates.f[a] > left_by_rounding(a) && found.rates.df[a] < 0 && !is_among(touching, a)) continue;
    zeros_of_f_[static_cast<std::size_t>(a)] = 1;
    if (found.rates.df[a] > options.contact_tolerance[a] * found.rates.df_scale[a]) opening.push_back(a);
  }
  if (!found.closing.empty()) {
    opening.insert(opening.end(), touching.begin(), touching.end());
    collide(found.closing, opening, switches);
  } else {
    begin_arc(touching, switches);
  }
}

bool Motion::EventDriven::advance(double until) {
  if (!may_advance(until)) return false;
  if (!ends_here_.empty()) {
    stop(ends_here_);
    forget_right_limits();
    return false;
  }
  until_ = until;
  const double before = since_start_, low_before = low_, clock_before = state.t;
  try {
    take_step(until);
  } catch (const convex::InvalidInput& error) {
    constexpr double grown = 1e12;
    const double largest =
        state.q.size() > 0 ? std::max(state.q.cwiseAbs().maxCoeff(), state.v.cwiseAbs().maxCoeff()) : 0;
    stop("at t = " + number_text(state.t) + ": " + error.what() +
         (largest > grown ? "; coordinates or velocities have grown to " + number_text(largest) +
                                ", as where a motion comes to infinity in a finite time"
                          : ""));
  }
  // Expressions with t in them see no time go by that is not told in it.
  const bool goes_on = since_start_ > before && (!expansion_.uses_time() || state.t > clock_before);
  events_at_once_ = goes_on ? 0 : events_at_once_ + 1;
  kinks_at_once_ = goes_on ? 0 : kinks_at_once_;
  const auto m = static_cast<long>(system.constraints().size());
  if (status == MotionStatus::done && events_at_once_ > most_events_at_once * (m + 1))
    stop("at t = " + number_text(state.t) + ": events follow each other without end at one instant" +
         advice_on_kinks());
  look_for_progress();
  if (status != MotionStatus::done && next.t != state.t) forget_right_limits();
  return status == MotionStatus::done || !events.empty() || goes_on || low_ > low_before;
}

/// What comes to 0 on the next arc ends it: constraints that are free, multipliers, arguments of switches.
void Motion::EventDriven::watch() {
  std::size_t count = 0;
  const auto add = [&](Zero::Of of, Index which, std::span<const double> c, int zeros, double rounding) {
    if (count == watched_.size()) watched_.emplace_back();
    Watched& one = watched_[count++];
    one.of = of;
    one.which = which;
    one.zeros = zeros;
    c = c.subspan(static_cast<std::size_t>(zeros));
    // On a branch that is not taken they may leave the range of doubles; half of them tell where it ends.
    const std::size_t enough = c.size() / 2;
    while (c.size() > enough && !std::isfinite(c.back())) c = c.first(c.size() - 1);
    if (!std::isfinite(c[0]) || !std::isfinite(c.back())) {  // not taken, or yet to come from a pole
      c = {};
      if (of == Zero::Of::branch) without_value_.push_back(static_cast<std::size_t>(which));
    }
    one.c.assign(c.begin(), c.end());
    one.rounding = rounding;
  };
  without_value_.clear();
  is_held_.assign(system.constraints().size(), false);
  is_counted_ = is_held_;
  for (const Index a : persist_) is_held_[static_cast<std::size_t>(a)] = true;
  for (const Index a : counted_) is_counted_[static_cast<std::size_t>(a)] = true;
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (is_two_sided(a)) continue;
    if (!is_held_[k]) {
      const double rounding = zeros_of_f_[k] > 0 ? 0 : 4 * epsilon * expansion_.position_scale(a);
      add(Zero::Of::constraint, a, coefficients(next.f, a), zeros_of_f_[k], rounding);
      continue;
    }
    // A contact without a multiplier has one from rounding: only what is more than that releases it.
    const double least = is_weak_[k] ? least_multiplier_[k] : 0;
    add(Zero::Of::multiplier, a, coefficients(next.lambda, a), zeros_of_lambda_[k], least);
    if (is_weak_[k]) watched_[count - 1].c[0] += room_of_weak * least;
  }
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    add(Zero::Of::branch, static_cast<Index>(k), expansion_.switch_argument(k), arguments_[k].zeros, 0);
    for (double& c : watched_[count - 1].c) c *= expansion_.branch(k);
  }
  watched_.resize(count);
}

/// Of a time so far ahead, at which something is 0.
double Motion::EventDriven::rounding_of_time(double ahead) const {
  const double of_t = expansion_.uses_time() ? roundings_of_t * std::abs(state.t) : 0;
  return epsilon * std::max(of_t, roundings_of_time * (since_start_ + ahead));
}

/// A time at which what is 0 is 0 by the text itself, not only by the polynomial.
double Motion::EventDriven::polished(const Zero& zero, double tau) {
  if (zero.is_touch || zero.of == Zero::Of::branch) return tau;
  constexpr int few_corrections = 4, most_corrections = 200;
  // Towards a zero of order p of f, each takes 1/p of what is left.
  constexpr double steady = 0.95;
  const auto k = static_cast<std::size_t>(zero.which);
  double last = 0, value_before = 0, tau_before = tau;
  for (int i = 0; i < most_corrections; ++i) {
    double value = 0, slope = 0;
    next.state(tau, there_, expected_q2_);
    if (zero.of == Zero::Of::constraint) {
      expansion_.look_at_constraints(there_);
      value = expansion_.f(zero.which);
      slope = expansion_.rate(zero.which);
    } else {
      if (is_weak_[k]) return tau;
      const std::optional<HeldRows::Answer> answer = acceleration_off_zero(there_, {}, tau);
      if (!answer) return tau;  // where T is not definite: `fits` halves the step
      for (std::size_t a = 0; a < counted_.size(); ++a)
        if (counted_[a] == zero.which) value = answer->lambda[static_cast<Index>(a)];
      slope = slope_at(coefficients(next.lambda, zero.which), tau);
    }
    // Where rounding is all there is of value and slope, a correction leads anywhere.
    if (i > 0 && !(std::abs(value) <= std::abs(value_before))) return tau_before;
    value_before = value;
    tau_before = tau;
    const double correction = value / slope;
    if (!(std::abs(correction) < 0.5 * tau)) return tau;
    tau -= correction;
    if (std::abs(correction) <= 2 * epsilon * tau) break;
    if (i >= few_corrections && !(std::abs(correction) <= steady * last)) break;
    last = std::abs(correction);
  }
  return tau;
}

void Motion::EventDriven::move_time(double by) {
  const double sum = since_start_ + by, part = sum - since_start_;
  low_ += (since_start_ - (sum - part)) + (by - part);
  since_start_ = sum + low_;
  low_ -= since_start_ - sum;
  state.t = start_ + since_start_ + low_;
}

/// Whether rounding leaves it open which of the two comes first. Both follow from one state, so that times
/// since the start tell them apart; an expression with t in it is known to the rounding of t.
bool Motion::EventDriven::is_at_once(const Zero& zero, const Zero& first) const {
  const auto by_t = [&](const Zero& one) {
    if (!expansion_.uses_time()) return 0.0;
    if (one.of == Zero::Of::multiplier) return 1.0;
    if (one.of == Zero::Of::branch)
      return expansion_.depends_on_time(static_cast<std::size_t>(one.which)) ? 1.0 : 0.0;
    return std::min(1.0, std::abs(expansion_.drift(one.which) / expansion_.rate(one.which)));
  };
  const double of_t = roundings_of_t * std::abs(state.t) * std::max(by_t(zero), by_t(first));
  return zero.at <= first.at + epsilon * std::max(of_t, roundings_of_time * (since_start_ + first.at));
}

void Motion::EventDriven::take_step(double until) {
  if (const std::vector<Zero> now = closing_at_once(); !now.empty()) {
    ++record.steps;
    std::swap(done, next);
    next.t = not_begun;
    done.length = 0;
    return handle(now);
  }
  const double goal = endings.empty() ? until : std::min(until, endings.front().t);
  const double left = std::max(0.0, goal - start_ - since_start_ - low_);
  double end = std::min(step_ahead_, left);
  bool is_last = end == left;
  std::vector<Zero> zeros;
  double tau = end;
  obstacle_.clear();
  across_.clear();
  for (int halvings = 0;; ++halvings) {
    if (halvings > most_halvings || (halvings > 0 && !(clock() + end > clock()))) {
      if (is_jump(tau, zeros)) break;
      return stop("at t = " + number_text(state.t) + ": " +
                  (obstacle_.empty() ? "no step, however short, keeps the tolerance" : obstacle_) +
                  "; the motion ends here, or the expressions have to be written otherwise");
    }
    zeros = first_zeros(watched_, end, rounding_of_time(end));
    tau = end;
    for (Zero& zero : zeros) {
      zero.at = polished(zero, zero.at);
      land_softly(zero, end);
      tau = std::min(tau, zero.at);
    }
    const auto is_past = [&](const Zero& zero) { return distance_of_zero(zero, tau) < 0; };
    if (tau <= 0 && (is_last || !zeros.empty())) break;
    if (fits(tau, halvings) && std::none_of(zeros.begin(), zeros.end(), is_past)) break;
    end = 0.5 * tau;
    is_last = false;
  }
  ++record.steps;
  const bool is_there = tau > 0 && across_.empty();  // by `fits`
  if (!is_there) next.state(tau, there_, expected_q2_);
  if (zeros.size() > 1) {
    const Zero first = *std::min_element(zeros.begin(), zeros.end(),
                                         [](const Zero& x, const Zero& y) { return x.at < y.at; });
    std::erase_if(zeros, [&](const Zero& zero) { return !is_at_once(zero, first); });
  }
  std::swap(done, next);
  next.t = not_begun;
  done.length = tau;
  since_event_ += tau;
  if (tau > 0) last_length_ = tau;
  state.q = there_.q;
  state.v = there_.v;
  expansion_.note_reach(state);
  if (is_last && zeros.empty()) {
    state.t = goal;
    since_start_ = goal - start_;
    low_ = 0;
  } else {
    move_time(tau);
  }
  for (double& elapsed : elapsed_) elapsed += tau;
  if (!is_there || (state.t != there_.t && expansion_.uses_time())) expansion_.set(state);
  look_for_penetration();
  if (status != MotionStatus::done) return;
  std::erase_if(zeros, [&](const Zero& zero) { return distance_of_zero(zero, tau) > 0; });
  if (is_last && zeros.empty() && tau > 0) zeros = closing_at_the_end();
  if (!zeros.empty()) close_together(zeros);
  zeros.empty() ? continue_arc() : handle(zeros);
  tell_endings();
}

/// Contacts that are closed as far as rounding tells close in the same event, however slow they are: their
/// own zero is uncertain by the rounding of f over df/dt, which is more than the rounding of t.
void Motion::EventDriven::close_together(std::vector<Zero>& zeros) const {
  const auto is_in = [&](Index a) {
    return std::any_of(zeros.begin(), zeros.end(),
                       [&](const Zero& zero) { return zero.of == Zero::Of::constraint && zero.which == a; });
  };
  const bool closes = std::any_of(zeros.begin(), zeros.end(),
                                  [](const Zero& zero) { return zero.of == Zero::Of::constraint; });
  for (Index a = 0; closes && a < expansion_.constraints(); ++a) {
    const bool is_free = !is_two_sided(a) && std::find(persist_.begin(), persist_.end(), a) == persist_.end();
    if (!is_free || is_in(a) || !(expansion_.rate(a) < 0)) continue;
    if (std::abs(expansion_.f(a)) <= roundings_of_f * epsilon * expansion_.position_scale(a))
      zeros.push_back({Zero::Of::constraint, a, done.length, false});
  }
}

/// At the end of a step, where the series of contacts held are worst, and all along it for the others.
void Motion::EventDriven::look_for_penetration() {
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    double f = is_two_sided(a) ? -std::abs(expansion_.f(a)) : expansion_.f(a);
    if (!is_two_sided(a) && !is_held_[static_cast<std::size_t>(a)])
      f = least_value(coefficients(done.f, a), done.length, std::min(f, 0.0));
    if (!(f < 0)) continue;
    const double scale = std::max(1.0, expansion_.position_scale(a));
    note_penetration(a, f, scale);
    const double passed = std::max(options.contact_tolerance[a], default_contact_tolerance);
    if (!is_two_sided(a) && -f > passed * scale && -f > passed * expansion_.magnitude_of_constraint(a))
      return stop("at t = " + number_text(state.t) + ": " + constraint_name(a) + " is penetrated, f = " +
                  number_text(f) + ", without an impact on the way; a smaller tolerance may show it");
  }
}

void Motion::EventDriven::continue_arc() {
  std::fill(zeros_of_f_.begin(), zeros_of_f_.end(), 0);
  project_after_step();
  if (status != MotionStatus::done) return;
  std::fill(zeros_of_lambda_.begin(), zeros_of_lambda_.end(), 0);
  for (Argument& one : arguments_) one.zeros = 0;
  if (!expansion_.gradients_taken_for_zero().empty()) take_rounding_of_gradients_for_zero(persist_);
  expansion_.expand({persist_, {}});
  if (const std::vector<Zero> left = left_behind(); !left.empty()) return handle(left);
  fill_next();
}

}  // namespace mechanics::inline motions
