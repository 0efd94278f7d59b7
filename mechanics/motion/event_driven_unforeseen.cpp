#include <algorithm>
#include <cmath>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/step_length.hpp"
#include "mechanics/motion/terms.hpp"

/// What the series of an arc do not tell of the arguments of branches and of free contacts, found by the text
/// at times of the step: they have jumped, as at a pole, or have a kink, or the series have too few orders.
namespace mechanics::inline motions {
namespace {

/// A contact is through when f is below 0 by more than so many roundings of its summands.
constexpr double roundings_of_passing = 1e3;

/// And jumps when it is off its series by more than so many of those that t has, too.
constexpr double roundings_of_jump = 64;

/// A number above 0 that a series tells to this part comes to 0 where the series does.
constexpr double part_told = 0.1;

/// A zero is told by the text where it is farther off than so many roundings of the time.
constexpr double roundings_of_zero = 1e3;

/// Whether a series tells 'told' for what is 'there', up to a rounding of both.
bool tells(double told, double there, double rounding) {
  return std::abs(there - told) <= part_told * std::min(std::abs(there), std::abs(told)) + rounding;
}

}  // namespace

/// Whether an argument is on its other side, or not where its series has it.
bool Motion::EventDriven::has_left_its_branch(std::size_t k, double tau) {
  const double there = expansion_.switch_argument(k)[0] * expansion_.branch(k);
  if (expansion_.branch(k) == 0 || std::isnan(there)) return false;
  if (watched_.size() < expansion_.switches()) return is_cut_ && -there > expansion_.rounding_of_argument(k);
  const Watched& one = watched_[watched_.size() - expansion_.switches() + k];
  const double terms = half_the_digits * terms_of_argument(k, tau);
  // Near a pole rounding makes terms beside which the first ones are nothing: such a series tells nothing.
  double first = 0;
  for (std::size_t j = std::min<std::size_t>(one.c.size(), 3); j-- > 0;)
    first = first * tau + std::abs(one.c[j]);
  const bool is_spoiled = terms > std::max(std::abs(there), first * std::pow(tau, one.zeros));
  const double digits = is_spoiled ? 0 : terms;
  if (there < 0) return (terms > 0 || is_cut_) && -there > digits + expansion_.rounding_of_argument(k);
  if (!(terms > 0)) return false;
  const double told = std::pow(tau, one.zeros) * value_at(one.c, tau);
  // The rounding of the argument takes a look at all series: it is asked for only where it may matter.
  return !tells(told, there, digits) && !tells(told, there, digits + expansion_.rounding_of_argument(k));
}

/// How long the series of the arc tried tell the motion: a polynomial does to its end.
double Motion::EventDriven::length_ahead() const {
  std::vector<double> sizes;
  expansion_.sizes(sizes);
  const double told = step_length(sizes, tolerance_of_step(options.tolerance)),
               left = std::isfinite(until_) ? until_ - state.t : 1;
  return std::isfinite(told) ? told : left;
}

/// Whether one of the arguments that stay 0 on other branches than that at 0 is 0 there wherever the motion
/// is, as that of max(x, 0) <= 0 for x < 0: then no state beside has that branch.
bool Motion::EventDriven::is_denied_beside(const std::vector<Index>& at_zero,
                                           const std::vector<double>& signs) {
  // Formulas are analytic: one that is 0 at a state which nothing singles out is 0 at all of them. That of
  // |x| is another one on the other side.
  constexpr double golden = 0.6180339887498949, far = 0.25, of_time = 0.125;
  for (const double side : {far, -far})
    for (const double later : {of_time * far, -of_time * far}) {
      State beside = state;
      double part = golden;
      const auto move = [&](double& x) {
        x += side * (1 + part) * std::max(1.0, std::abs(x));
        part = std::fmod(part + golden, 1.0);
      };
      for (Index i = 0; i < expansion_.coordinates(); ++i) move(beside.q[i]), move(beside.v[i]);
      beside.t += later * std::max(1.0, std::abs(state.t));
      expansion_.look_at_arguments(beside);
      if (std::any_of(at_zero.begin(), at_zero.end(), [&](Index which) {
            const auto k = static_cast<std::size_t>(which);
            return signs[k] == 0 && expansion_.branch(k) != 0 &&
                   std::abs(expansion_.switch_argument(k)[0]) <= expansion_.rounding_of_argument(k);
          }))
        return true;
    }
  return false;
}

/// The signs with which arguments at 0 go on whose derivatives have no bound, by the text on the arc ahead:
/// each at the first time, of a geometric sequence, at which the argument is more than rounding may have made
/// it.
void Motion::EventDriven::take_signs_beside(const std::vector<Index>& switches, std::vector<double>& signs) {
  Arc ahead;
  ahead.t = state.t;
  ahead.q.resize(expansion_.coordinates(), expansion_.order() + 1);
  for (Index i = 0; i < ahead.q.rows(); ++i)
    std::copy_n(expansion_.position(i).begin(), ahead.q.cols(), ahead.q.row(i).begin());
  const double length = length_ahead();
  constexpr double ratio = 16;
  State there;
  for (double tau = std::max(epsilon * epsilon * length, rounding_of_time(0)); tau <= length; tau *= ratio) {
    ahead.state(tau, there);
    try {
      expansion_.look_at(there);
    } catch (const convex::InvalidInput&) {
      continue;
    }
    for (const Index which : switches) {
      const auto k = static_cast<std::size_t>(which);
      const double argument = expansion_.switch_argument(k)[0];
      if (signs[k] == 0 && std::abs(argument) > expansion_.rounding_of_argument(k))
        signs[k] = std::copysign(1.0, argument);
    }
    if (std::all_of(switches.begin(), switches.end(),
                    [&](Index k) { return signs[static_cast<std::size_t>(k)] != 0; }))
      return;
  }
}

/// Where roots or powers of what is 0 but for rounding count as 0, an argument that is 0 as far, and stays
/// what it is, has come to rest there: a velocity under -√v does so in a finite time, and does not cross 0.
void Motion::EventDriven::come_to_rest(std::vector<Zero>& zeros) {
  const auto near = expansion_.arguments_left_by_rounding();
  std::vector<Index> which;
  for (const auto& one : near) which.push_back(one.first);
  const auto roundings = expansion_.rounding_of_switches(which, expansion_.order() - 1);
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto k = static_cast<std::size_t>(which[i]);
    const std::span<const double> c = expansion_.switch_argument(k).first(expansion_.known_of_argument(k));
    bool stays = true;
    for (std::size_t j = 1; j < c.size(); ++j) stays = stays && std::abs(c[j]) <= roundings[i][j];
    if (stays)
      zeros.push_back({Zero::Of::branch, which[i], done.length, false, false, false, near[i].second});
  }
}

/// A contact whose gradient others make up, and which a higher derivative opens, stays among those that
/// persist where f is not seen to leave 0 on the arc ahead: rounding of lower orders covers it as far as the
/// series reach, and zeros of f there are those of rounding.
void Motion::EventDriven::keep_unseen(ContactAnswer& answer) {
  std::vector<Index> in_question;
  for (const auto& [a, order] : answer.open)
    if (order > 2 && expansion_.is_nearly_implied(a, answer.persist)) in_question.push_back(a);
  if (in_question.empty()) return;
  const double length = length_ahead();
  const auto roundings = expansion_.rounding_of_rates(in_question, expansion_.order() - 1);
  std::erase_if(answer.open, [&](const ContactAnswer::Opening& one) {
    const auto found = std::find(in_question.begin(), in_question.end(), one.constraint);
    if (found == in_question.end()) return false;
    const std::vector<double>& left = roundings[static_cast<std::size_t>(found - in_question.begin())];
    double covered = 0, power = length;
    for (std::size_t j = 0; static_cast<int>(j) + 1 < one.order; ++j, power *= length)
      covered += left[j] * power / static_cast<double>(j + 1);
    const double opened = expansion_.constraint(one.constraint)[static_cast<std::size_t>(one.order)] * power;
    if (opened > covered) return false;
    answer.persist.push_back(one.constraint);
    return true;
  });
}

/// The switches of which that holds at a time of the next arc.
void Motion::EventDriven::note_across(double tau) {
  for (std::size_t k = 0; k < expansion_.switches(); ++k)
    if (const auto which = static_cast<Index>(k); has_left_its_branch(k, tau) && !is_among(across_, which))
      across_.push_back(which);
}

/// Whether a contact that is free at the beginning, or has no part in what is held, is through at a time of
/// the arc, or its series does not tell that it is not.
bool Motion::EventDriven::is_passed(double at) {
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    if (is_two_sided(a) || is_counted_[static_cast<std::size_t>(a)]) continue;
    const double there = expansion_.f(a);
    const std::span<const double> c = coefficients(next.f, a);
    const double least = options.tolerance *
                         std::max(expansion_.position_scale(a), expansion_.rate_scale(a) * at),
                 beyond = std::min(0.0, c[0]) - there;
    const bool is_told = tells(value_at(c, at), there, least + half_the_digits * sum_of_terms(c, at));
    if (is_told && !(beyond > least)) continue;
    // f may have constants whose rounding is more than what it is now.
    const double rounding =
        std::max(roundings_of_passing * epsilon * system.constraint_rates(there_).f_scale[a],
                 roundings_of_jump * rounding_of_f(a));
    if (beyond > std::max(least, rounding) || (!is_told && std::abs(there - value_at(c, at)) > rounding)) {
      obstacle_ = constraint_name(a) + (beyond > 0 ? " is passed, and its series does not tell when"
                                                   : " jumps, or its series does not tell where it is");
      return true;
    }
  }
  return false;
}

/// Whether arguments have jumped in a step of less than the time tells, in which nothing else goes on: not
/// where the motion comes to infinity.
bool Motion::EventDriven::is_jump(double tau, std::vector<Zero>& zeros) {
  if (across_.empty() || !(largest_term(sizes_, tau) <= 2 * (sizes_[1] + sizes_[2] * tau) * tau))
    return false;
  for (const Index k : across_) zeros.push_back({Zero::Of::branch, k, tau, false, false, true});
  return true;
}

/// Whether an argument has jumped and a force is so large beyond that the velocity hangs on the rounding of
/// the time: it is far larger than where the motion soon leads.
bool Motion::EventDriven::leads_from_pole() {
  if (std::none_of(arguments_.begin(), arguments_.end(), [](const Argument& one) { return one.jumps; }))
    return false;
  constexpr double soon = 1e-3;
  const double ahead = soon * clock();
  const State beside{state.t + ahead, state.q + ahead * state.v, state.v};
  const auto answer = acceleration_off_zero(beside, {});
  const double usual = answer ? expansion_.norm(answer->x) : 0;
  expansion_.set(state);
  const double largest =
      std::max(expansion_.norm(acceleration), expansion_.norm(done.acceleration(done.length)));
  return largest * rounding_of_time(0) > half_the_digits * (expansion_.norm(state.v) + usual * clock());
}

/// How far an argument is before its zero at the end of a step, or past it, < 0, by the text: 0 where
/// rounding does not tell. The polynomial tells a zero of higher order no better than to where it is within
/// rounding, and far from it takes two zeros for a touch.
double Motion::EventDriven::distance_of_zero(const Zero& zero, double tau) {
  const double moment = rounding_of_time(0);
  if (zero.of != Zero::Of::branch || zero.is_jump) return 0;
  if (!(tau > roundings_of_zero * moment)) return 0;
  const auto k = static_cast<std::size_t>(zero.which);
  const double distance = expansion_.switch_argument(k)[0] * expansion_.branch(k),
               left = expansion_.rounding_of_argument(k) + rate_of_argument(k, tau) * moment;
  return std::abs(distance) > left ? (zero.is_touch ? std::min(distance, 0.0) : distance) : 0;
}

}  // namespace mechanics::inline motions
