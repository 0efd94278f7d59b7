#include "mechanics/motion/rounding_growth.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace mechanics::inline motions {
namespace {

/// Row k of Sylvester's matrix gives the signs; `number` counts the entries that are moved: by a rounding of
/// their own, or, of those that are 0, of what they become on the way.
void move_by_a_rounding(Vector& x, const Vector& sizes, unsigned k, unsigned& number) {
  for (Index i = 0; i < x.size(); ++i) {
    const double size = x[i] == 0 ? sizes[i] : std::abs(x[i]);
    if (size == 0) continue;
    const double by =
        std::copysign(std::nextafter(size, std::numeric_limits<double>::infinity()) - size, x[i]);
    x[i] += std::popcount(k & number++) % 2 == 0 ? by : -by;
  }
}

/// What has not grown so many times is no loss: numbers that are rounding themselves change by all they are.
/// Roundings on the way of a regular motion add up to less. A rounding that reaches the digits that are
/// printed has grown 1e10 times, so that anything between decides alike.
constexpr double least_growth = 1e3;

/// A motion that takes more steps than these is another one.
constexpr long most_steps_of_ended = 4, steps_besides = 100;

/// The largest |q_i| and |v_i| so far.
struct Sizes {
  Vector q, v;
  void take(const State& at) {
    q = q.cwiseMax(at.q.cwiseAbs());
    v = v.cwiseMax(at.v.cwiseAbs());
  }
};

/// The end of a motion. What strikes right at the end does so before it or after it as a rounding has it:
/// then the velocity is that before the impact.
struct End {
  State state;
  long struck = 0;  ///< the number of that impact; 0: none
  /// Of a motion that begins on contacts, the first state that no contact holds, and the impacts before it.
  std::optional<State> apart = {};
  long impacts_before = 0;
};

/// The first impact right at the end of a motion.
const MotionEvent* impact_at_end(const std::vector<MotionEvent>& events, const State& start, double until) {
  const double size = std::max(std::abs(start.t), std::abs(until));
  const double margin = least_growth * std::numeric_limits<double>::epsilon() * size;
  const auto found = std::find_if(events.begin(), events.end(), [&](const MotionEvent& event) {
    return event.kind == EventKind::impact && event.t >= until - margin;
  });
  return found == events.end() ? nullptr : &*found;
}

bool holds_contact(const LagrangianSystem& system, const Arc& arc) {
  return std::any_of(arc.persist.begin(), arc.persist.end(),
                     [&](Index a) { return !system.constraints()[static_cast<std::size_t>(a)].two_sided; });
}

/// The end of the motion from there; nothing where it has another one. `struck`: the impact of this number is
/// the one at the end, in the motion beside which this is; 0: there is none.
std::optional<End> end_of(const LagrangianSystem& system, const State& start, const MotionOptions& options,
                          double until, long struck, Sizes& sizes) {
  try {
    Motion motion(system, start, options);
    End end;
    std::optional<Vector> before;
    bool any_held = false;
    for (long so_far = 0; motion.advance(until); so_far = motion.record().impacts) {
      const bool are_held = holds_contact(system, motion.arc());
      if (any_held && !are_held && !end.apart) {
        end.apart = motion.arc().state(0.5 * motion.arc().length);
        end.impacts_before = so_far;
      }
      any_held = any_held || (are_held && so_far == 0);
      const long impacts = motion.record().impacts;
      const MotionEvent* at_end = impact_at_end(motion.events(), start, until);
      if (struck > 0 && impacts == struck) {
        const auto last = std::find_if(motion.events().begin(), motion.events().end(),
                                       [](const MotionEvent& one) { return one.kind == EventKind::impact; });
        at_end = last == motion.events().end() ? nullptr : &*last;
      }
      if (!before && at_end != nullptr) {
        before = at_end->velocity_before;
        end.struck = impacts;
      }
      sizes.take(motion.arc().state(0.5 * motion.arc().length));
      sizes.take(motion.state());
    }
    if (motion.status() == MotionStatus::done && motion.state().t == until) {
      end.state = motion.state();
      if (before) end.state.v = *before;
      return end;
    }
  } catch (const convex::InvalidInput&) {  // contacts that a rounding opens or closes
  }
  return std::nullopt;
}

/// What roundings of `start` have become at the end of the motion from there.
std::optional<RoundingGrowth> grown(const LagrangianSystem& system, const State& start,
                                    const MotionOptions& options, const End& end, long struck, Sizes sizes,
                                    Index most) {
  const Sizes on_the_way = sizes;
  unsigned numbers = 0;
  State other = start;
  move_by_a_rounding(other.q, on_the_way.q, 0, numbers);
  move_by_a_rounding(other.v, on_the_way.v, 0, numbers);
  if (numbers == 0) return std::nullopt;
  const unsigned order = std::bit_ceil(numbers);
  const double dq = (other.q - start.q).lpNorm<Eigen::Infinity>();
  const double dv = (other.v - start.v).lpNorm<Eigen::Infinity>();
  unsigned followed = 0;
  Vector change_q = Vector::Zero(start.q.size()), change_v = change_q;  // the worst
  for (unsigned k = 0; k < order && k < most; ++k) {
    other = start;
    unsigned number = 0;
    move_by_a_rounding(other.q, on_the_way.q, k, number);
    move_by_a_rounding(other.v, on_the_way.v, k, number);
    const std::optional<End> then = end_of(system, other, options, end.state.t, struck, sizes);
    if (!then) continue;
    ++followed;
    change_q = change_q.cwiseMax((then->state.q - end.state.q).cwiseAbs());
    change_v = change_v.cwiseMax((then->state.v - end.state.v).cwiseAbs());
  }
  if (followed == 0) return std::nullopt;
  RoundingGrowth found;
  const double time = end.state.t - start.t;
  const auto look = [&](Index i, bool of_velocity, double change, double size, double error) {
    if (change > std::max(found.part * size, least_growth * error))
      found = {i, of_velocity, change, change / size};
  };
  for (Index i = 0; i < change_q.size(); ++i) {
    look(i, false, change_q[i], sizes.q[i], dq + dv * time);
    // An oscillation turns an error of its position into one of its velocity.
    const double rate = std::max(time > 0 ? 1 / time : 0, sizes.q[i] > 0 ? sizes.v[i] / sizes.q[i] : 0);
    look(i, true, change_v[i], sizes.v[i], dv + dq * rate);
  }
  if (followed == order) found.bound_over_change = std::sqrt(static_cast<double>(numbers));
  return found;
}

}  // namespace

std::optional<RoundingGrowth> rounding_growth(const LagrangianSystem& system, const State& start,
                                              const MotionOptions& options, const Motion& ended, Index most) {
  Sizes sizes{start.q.cwiseAbs(), start.v.cwiseAbs()};
  sizes.take(ended.state());
  MotionOptions beside = options;
  beside.step_limit =
      std::min(options.step_limit, most_steps_of_ended * ended.record().steps + steps_besides);
  End end{ended.state()};
  std::optional<State> apart;
  long impacts_before = 0;
  if (const auto again = end_of(system, start, beside, end.state.t, 0, sizes)) {
    apart = again->apart, impacts_before = again->impacts_before;
    if (ended.record().impacts > 0) end = *again;
  }
  auto found = grown(system, start, beside, end, end.struck, sizes, most);
  // A contact that holds takes up what a rounding of the start has moved.
  if (apart) {
    const long struck = end.struck > 0 ? end.struck - impacts_before : 0;
    const auto later = grown(system, *apart, beside, end, struck, sizes, most);
    if (later && (!found || later->part > found->part)) found = later;
  }
  return found;
}

}  // namespace mechanics::inline motions
