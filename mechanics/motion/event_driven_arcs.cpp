#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "mechanics/data_radii.hpp"
#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/step_length.hpp"
#include "mechanics/motion/terms.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

/// Where q'' at the end of a step is off by more than this part of the forces, it has jumped.
constexpr double largest_part = 1e-3;

/// Where a step is looked at besides its end: parts that no period of an expression is a multiple of.
constexpr double parts_looked_at[] = {0.191, 0.433, 0.719};

/// A series with few orders is for a step away from where it ends: so many one after the other lose digits.
constexpr long most_cut_in_a_row = 1000;

/// A motion is known to so many roundings of its length.
constexpr double roundings_of_motion = 16;

/// What the constants of f and df/dt leave of a contact that is held.
constexpr double roundings_of_constants = 16;

/// Whether the last four terms of a series are no less than the four before: then what follows is not small
/// because they are.
bool is_rising(const std::vector<double>& sizes, double h) {
  std::size_t top = sizes.size() - 1;
  while (top > 0 && sizes[top] == 0) --top;
  if (top < 8) return false;
  double last = 0, before = 0, power = 1;
  for (std::size_t k = top - 7; k <= top; ++k, power *= h)
    (k + 4 > top ? last : before) = std::max(k + 4 > top ? last : before, sizes[k] * power);
  return last >= before;
}

/// What leaves 0 on a step ends it where its own accelerations are seen no more, but no step is halved more
/// often for it: it is a part of 1e-12 of the first one then.
constexpr int halvings_until_left = 40;

/// An impact within so many roundings of the end of the motion is at its end.
constexpr double roundings_of_end = 4;

}  // namespace

/// Whether the equations hold at the end of a step as they did at its beginning: this tells a series that
/// does not converge, and an expression that is not analytic. Where the series was not what limits the step,
/// they are looked at within it too.
bool Motion::EventDriven::fits(double tau, int halvings) {
  const bool may_leave_zero = halvings < halvings_until_left;
  if (is_blind_)
    for (const double part : parts_looked_at)
      if (!is_met(part * tau, tau, may_leave_zero)) return false;
  return is_met(tau, tau, may_leave_zero);
}

/// The same at one of its times. What had no value at the beginning of the arc, as 10/|v| at rest, is on the
/// side there that it has by then.
bool Motion::EventDriven::is_met(double at, double tau, bool may_leave_zero) {
  next.state(at, there_, expected_q2_);
  std::vector<std::size_t> turned;
  if (!without_value_.empty()) expansion_.look_at_arguments(there_);
  for (const std::size_t k : without_value_)
    if (expansion_.switch_argument(k)[0] * expansion_.branch(k) < 0) turned.push_back(k);
  for (const std::size_t k : turned) expansion_.branch(k) *= -1;
  const bool is_met = is_met_on_branches(at, tau, may_leave_zero);
  if (!is_met || at < tau)
    for (const std::size_t k : turned) expansion_.branch(k) *= -1;
  return is_met;
}

bool Motion::EventDriven::is_met_on_branches(double at, double tau, bool may_leave_zero) {
  double pull = 0;
  across_.clear();
  try {
    expansion_.set(there_);
    const std::optional<HeldRows::Answer> answer =
        may_leave_zero ? acceleration_off_zero(at) : expansion_.acceleration(counted_);
    if (!answer) return false;
    q2_ = answer->x;
    if (may_leave_zero) pull = pull_of_weak(answer->lambda);
  } catch (const convex::InvalidInput& error) {
    obstacle_ = error.what();
    return false;
  }
  if (is_passed(at)) return false;
  note_across(at);
  if (!across_.empty()) return false;
  // Of a series that ends before a derivative without a bound the last terms may be of any size.
  const double moved = ends_early_ ? (sizes_[1] + sizes_[2] * tau) * tau : largest_term(sizes_, tau);
  const double size = expansion_.norm(q2_);
  q2_ -= expected_q2_;
  const double miss = expansion_.norm(q2_) + pull;
  const double defect = miss * tau * tau;
  const double bend = size + expansion_.force_norm();
  const double rounding = 1e4 * epsilon * (moved + bend * tau * tau);
  if (!std::isfinite(defect + rounding)) return false;
  // The last term of a series, which a step aims at, enters q'' with the square of its order.
  const double orders = is_cut_ ? 1 : static_cast<double>(next.q.cols());
  // A tolerance of what moves allows any jump of q'' in a step that is short enough, such as one that no
  // branch tells, of hypot(x, y) through 0: no more than rounding is stepped over there.
  const bool jumps = miss > largest_part * bend;
  const double allowed =
      jumps ? 0 : std::max(options.tolerance, orders * orders * tolerance_of_step(options.tolerance));
  if (defect <= allowed * moved + rounding) return true;
  // Away from where a derivative has no bound a step leads that is nothing beside the whole motion.
  if (is_cut_ && tau <= roundings_of_motion * epsilon * std::max(until_ - start_, clock())) {
    double higher = 0;
    for (std::size_t k = sizes_.size(); k-- > 3;) higher = (higher + sizes_[k]) * tau;
    if (higher <= bend + expansion_.norm(expected_q2_)) return true;
  }
  // Forces that cancel have the rounding of their terms.
  return defect <= expansion_.rounding_of_acceleration() * tau * tau;
}

/// By how much contacts held without a multiplier would pull, as an acceleration.
double Motion::EventDriven::pull_of_weak(const Vector& lambda) {
  double pull = 0;
  for (std::size_t k = 0; k < counted_.size(); ++k) {
    const auto a = static_cast<std::size_t>(counted_[k]);
    const double beyond = -lambda[static_cast<Index>(k)] - room_of_weak * least_multiplier_[a];
    if (is_weak_[a] && beyond > 0)
      pull += beyond * expansion_.inertia().dual_norm(expansion_.row(counted_[k]));
  }
  return pull;
}

/// Contacts without a multiplier, with a gradient that is nearly one of the others', are let go where to hold
/// them would turn the velocity: along what is left of it the motion is not at rest, however small f and
/// df/dt are, as those of y >= -x^8 beside a floor y >= 0 that x moves along.
bool Motion::EventDriven::let_go_of_moving() {
  const auto is_weak = [this](Index a) { return may_be_implied(a); };
  const auto change = [this](const std::vector<Index>& held) {
    Vector rates(static_cast<Index>(held.size()));
    for (std::size_t k = 0; k < held.size(); ++k) rates[static_cast<Index>(k)] = expansion_.rate(held[k]);
    return held.empty() ? 0.0 : expansion_.norm(expansion_.held_rows(held).least_change(-rates));
  };
  if (std::none_of(persist_.begin(), persist_.end(), is_weak)) return false;
  const double least = half_the_digits * expansion_.norm(state.v);
  std::vector<Index> held;
  std::copy_if(persist_.begin(), persist_.end(), std::back_inserter(held), std::not_fn(is_weak));
  double last = change(held);
  for (const Index a : persist_) {
    if (!is_weak(a)) continue;
    const bool is_implied = !is_among(counted_, a) || expansion_.is_nearly_implied(a, held);
    held.push_back(a);
    const double turned = change(held);
    if (is_implied && turned > last + least) {
      held.pop_back();
      const bool is_at_zero = expansion_.f(a) <= roundings_of_closed * epsilon * expansion_.position_scale(a);
      zeros_of_f_[static_cast<std::size_t>(a)] = is_at_zero && expansion_.rate(a) > 0 ? 1 : 0;
    } else {
      last = turned;
    }
  }
  if (held.size() == persist_.size()) return false;
  persist_ = std::move(held);
  return true;
}

/// With a gradient that others make up as the arc begins a contact without a multiplier has no part in it,
/// and takes none up on the way, where rounding tells them apart.
void Motion::EventDriven::take_counted(const std::vector<Index>& independent) {
  counted_.clear();
  for (std::size_t k = 0; k < persist_.size(); ++k)
    if (!may_be_implied(persist_[k]) || is_among(independent, static_cast<Index>(k)))
      counted_.push_back(persist_[k]);
}

/// Back to f = 0 and df/dt = 0 of the contacts held, by the least change in the kinetic metric.
void Motion::EventDriven::project() {
  if (persist_.empty()) return counted_.clear();
  constexpr int most_corrections = 12;
  constexpr double smallest = 4 * epsilon, largest = 1e-6;
  const auto rows = static_cast<Index>(persist_.size());
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_corrections; ++i) {
    const HeldRows held = expansion_.held_rows(persist_);
    Vector f(rows), rate(rows);
    for (Index a = 0; a < rows; ++a) {
      f[a] = expansion_.f(persist_[static_cast<std::size_t>(a)]);
      rate[a] = expansion_.rate(persist_[static_cast<std::size_t>(a)]);
    }
    const Vector dq = held.least_change(-f), dv = held.least_change(-rate);
    const convex::Metric& A = expansion_.inertia();
    const double by_q = A.norm(dq), by_v = A.norm(dv);
    const double q = A.norm(state.q), v = A.norm(state.v);
    if (i == 0 && by_v > half_the_digits * v && let_go_of_moving()) return project();
    take_counted(held.independent());
    const bool is_small = by_q <= smallest * q && by_v <= smallest * v;
    const double size = std::max(by_q / std::max(q, by_q + 1e-300), by_v / std::max(v, by_v + 1e-300));
    if (is_small || (i > 1 && size > 0.5 * last && size < largest)) return;
    last = size;
    state.q += dq;
    state.v += dv;
    expansion_.set(state);
  }
  if (last < largest) return;
  // Constants in f and in df/dt have roundings that the coordinates do not tell of.
  const ConstraintRates rates = system.constraint_rates(state);
  if (std::all_of(persist_.begin(), persist_.end(), [&](Index a) {
        return std::abs(expansion_.f(a)) <= roundings_of_constants * epsilon * rates.f_scale[a] &&
               std::abs(expansion_.rate(a)) <= roundings_of_constants * epsilon * rates.df_scale[a];
      }))
    return;
  stop_at_dependent_rows();
}

/// At the end of a step the way back to df/dt = 0 is as short as the step is right. Where it turns the
/// velocity, beside a singular position, the rows held do not tell it.
void Motion::EventDriven::project_after_step() {
  constexpr double largest_turn =
      1e-4;  // of the velocities there have been, and of what forces make in a step
  const Vector v = state.v;
  project();
  if (status != MotionStatus::done || persist_.empty() || state.v == v) return;
  Vector fastest(v.size());
  for (Index i = 0; i < v.size(); ++i) fastest[i] = std::max(std::abs(v[i]), expansion_.fastest(i));
  const double largest = expansion_.norm(fastest) + expansion_.force_norm() * done.length;
  if (expansion_.norm(state.v - v) > largest_turn * largest) stop_at_dependent_rows();
}

/// Whether a coordinate at rest is pushed away from where it is by more than in proportion to the distance,
/// as by √x: then several motions lead from there (Peano 1890).
bool Motion::EventDriven::may_leave_rest() {
  constexpr double far = 1e-6, near = 1e-12, steeper = 10, least_push = 1e-9;
  const double size = std::max(expansion_.force_norm(), 1.0);
  bool may_leave = false;
  std::vector<std::size_t> at_zero;
  for (std::size_t k = 0; k < expansion_.switches(); ++k)
    if (std::abs(expansion_.switch_argument(k)[0]) <= expansion_.rounding_of_argument(k))
      at_zero.push_back(k);
  for (Index i = 0; i < expansion_.coordinates() && !may_leave; ++i) {
    if (expansion_.position(i)[1] != 0 || expansion_.position(i)[2] != 0) continue;
    for (const bool of_velocity : {false, true})
      for (const double side : {-1.0, 1.0}) {
        const auto push = [&](double distance) {
          State beside = state;
          (of_velocity ? beside.v : beside.q)[i] += side * distance * std::max(1.0, std::abs(state.q[i]));
          const auto answer = acceleration_off_zero(beside, at_zero);
          return answer ? side * answer->x[i] : 0.0;
        };
        const double here = push(0), by_near = push(near) - here, by_far = push(far) - here;
        may_leave = may_leave || (by_near > least_push * size && by_near / near > steeper * by_far / far);
      }
    expansion_.set(state);
    expansion_.expand({persist_, {}});
  }
  return may_leave;
}

void Motion::EventDriven::fill_next() {
  is_cut_ = expansion_.cut() > 0;
  ends_early_ = expansion_.ends_early();
  cut_in_a_row_ = ends_early_ ? cut_in_a_row_ + 1 : 0;
  if (is_cut_ && cut_in_a_row_ > most_cut_in_a_row)
    expansion_.refuse_cut("; so it was for a thousand steps in a row");
  if (is_cut_ && may_leave_rest())
    expansion_.refuse_cut(
        "; a force may push off what is at rest there, as sqrt(x) or -sqrt(abs(x')) does, and more than one "
        "motion lead from it");
  const Index n = expansion_.coordinates(), m = expansion_.constraints(), last = expansion_.order();
  next.t = state.t;
  next.q.resize(n, last + 1);
  next.lambda.resize(m, last - 1);
  next.f.resize(m, last + 1);
  const auto copy = [](convex::RowMatrix& to, Index row, std::span<const double> c) {
    std::copy(c.begin(), c.end(), to.data() + row * to.cols());
  };
  for (Index i = 0; i < n; ++i) copy(next.q, i, expansion_.position(i));
  for (Index a = 0; a < m; ++a) {
    copy(next.lambda, a, expansion_.multiplier(a));
    copy(next.f, a, expansion_.constraint(a));
  }
  next.persist = persist_;
  acceleration = 2 * next.q.col(2);
  multipliers = next.lambda.col(0);
  std::vector<Index> at_zero;
  for (std::size_t k = 0; k < expansion_.switches(); ++k)
    if (expansion_.branch(k) == 0) at_zero.push_back(static_cast<Index>(k));
  auto roundings = expansion_.rounding_of_switches(at_zero, orders_at_zero);
  for (std::size_t i = 0; i < at_zero.size(); ++i)
    arguments_[static_cast<std::size_t>(at_zero[i])].rounding_of_zero = std::move(roundings[i]);
  const double tolerance = tolerance_of_step(options.tolerance);
  expansion_.sizes(sizes_);
  step_ahead_ = step_length(sizes_, tolerance);
  const double told = step_ahead_;
  for (const FunctionArgument& one : expansion_.arguments())
    step_ahead_ = seen_length(expansion_.argument(one), one.of, step_ahead_, reach_);
  stretch_.is_of_series = stretch_.is_of_series && std::isfinite(told) && step_ahead_ == told;
  is_blind_ = is_cut_ || (!expansion_.arguments().empty() &&
                          (step_ahead_ < told || std::isinf(told) || is_rising(sizes_, step_ahead_)));
  watch();
  // Of a series of zeros nothing is known but that it begins so, as that of t^40.
  const bool may_hide = std::isinf(told) && (m > 0 || expansion_.switches() > 0);
  is_blind_ = is_blind_ || !without_value_.empty() || expansion_.may_jump() || may_hide;
  for (const Watched& one : watched_) {
    const auto which = static_cast<std::size_t>(one.which);
    if (one.of == Zero::Of::multiplier && is_weak_[which]) continue;
    // A quotient that is far from its pole is nothing beside a number it is compared with, but comes near.
    const bool hides = (one.of == Zero::Of::branch && expansion_.argument_may_hide(which)) ||
                       (one.of == Zero::Of::constraint && expansion_.constraint_may_hide(one.which));
    const std::span<const double> c(one.c), seen = hides && c.size() > 1 ? c.subspan(1) : c;
    const double length = std::min(trusted_length(c, tolerance), trusted_length(seen, tolerance));
    step_ahead_ = std::min(step_ahead_, std::max(length, rounding_of_time(0)));
  }
}

/// Free contacts whose f comes to 0 at the end of the motion asked for, as far as the rounding of time tells:
/// what the series left of f there need not be below 0.
std::vector<Zero> Motion::EventDriven::closing_at_the_end() {
  std::vector<Zero> found;
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    if (is_two_sided(a) || is_held_[static_cast<std::size_t>(a)]) continue;
    const double f = expansion_.f(a), rate = expansion_.rate(a);
    if (rate < -expansion_.rounding_of_rate(a) && f <= -rate * roundings_of_end * epsilon * clock())
      found.push_back({Zero::Of::constraint, a, done.length, false});
  }
  return found;
}

void Motion::EventDriven::take_rounding_of_gradients_for_zero(const std::vector<Index>& contacts) {
  std::vector<Index> lost;
  for (const Index a : contacts)
    if (!is_two_sided(a) && expansion_.has_lost_gradient(a)) lost.push_back(a);
  const convex::SparseRows U = gradients_beyond_rounding(system, state, lost);
  std::vector<Index> vanishing;
  for (Index k = 0; k < U.rows(); ++k)
    if (U.row(k).nonZeros() == 0) vanishing.push_back(lost[static_cast<std::size_t>(k)]);
  expansion_.take_gradients_for_zero(std::move(vanishing));
}

}  // namespace mechanics::inline motions
