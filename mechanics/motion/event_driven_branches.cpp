#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

/// Events within so many roundings of the time follow each other at one instant.
constexpr double roundings_of_instant = 64;

}  // namespace

Motion::EventDriven::Switches Motion::EventDriven::switches_before_jump(
    const std::vector<Index>& at_zero) const {
  Switches before{{}, {}, at_zero};
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    before.arguments.push_back(expansion_.switch_argument(k)[0]);
    before.branches.push_back(expansion_.branch(k));
  }
  return before;
}

/// After a jump of the velocity: the branches by the signs of their arguments now. Returns those that are at
/// 0: of what the impact did not move those that were, of what it did those that it left at 0.
std::vector<Index> Motion::EventDriven::branches_after_jump(const Switches& before) {
  constexpr double left_by_rounding = 64 * std::numeric_limits<double>::epsilon();
  for (std::size_t k = 0; k < expansion_.switches(); ++k) expansion_.branch(k) = before.branches[k];
  std::vector<Index> at_zero;
  if (is_defined_here()) {
    note_behind();
    at_zero = find_branches();
  } else {  // as a power of |v| where v has turned
    at_zero = find_branches();
    expansion_.set(state);
    note_behind();
  }
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {
    const double now = expansion_.switch_argument(k)[0], then = before.arguments[k];
    const bool stays = now == then && is_among(before.at_zero, static_cast<Index>(k));
    const bool comes = now != then && std::abs(now) <= left_by_rounding * std::abs(then);
    if (now != 0 && (stays || comes)) at_zero.push_back(static_cast<Index>(k));
  }
  return at_zero;
}

/// Whether all has a value at the state, on the branches as they are; arguments of branches are known anyhow.
bool Motion::EventDriven::is_defined_here() {
  try {
    expansion_.set(state);
    return true;
  } catch (const convex::InvalidInput&) {
    return false;
  }
}

/// The branch of every switch by the sign of its argument; returns those whose argument is 0.
std::vector<Index> Motion::EventDriven::find_branches() {
  std::vector<Index> at_zero;
  for (std::size_t k = 0; k < expansion_.switches(); ++k) {  // an argument may contain the switches before it
    const double argument = expansion_.switch_argument(k)[0], branch = argument > 0 ? 1 : -1;
    if (argument == 0) at_zero.push_back(static_cast<Index>(k));
    if (argument == 0 || branch == expansion_.branch(k)) continue;
    expansion_.branch(k) = branch;
    is_defined_here();
  }
  return at_zero;
}

/// At a start where arguments are 0: df/dt of contacts on the sides to which the velocity leads, so far as it
/// tells them, and who is present and closing there. On the side that the text has df/dt says nothing of what
/// is ahead.
void Motion::EventDriven::take_sides_ahead(Contacts& found, const std::vector<Index>& switches) {
  std::vector<double> sides;
  for (const Index which : switches) sides.push_back(expansion_.branch(static_cast<std::size_t>(which)));
  try {
    expansion_.expand({});
  } catch (const convex::InvalidInput&) {  // undefined on these branches, which need not be those ahead
    return;
  }
  const auto roundings = expansion_.rounding_of_switches(switches, 2);
  for (std::size_t i = 0; i < switches.size(); ++i) {
    const auto k = static_cast<std::size_t>(switches[i]);
    const double speed = expansion_.switch_argument(k)[1];
    if (!expansion_.depends_on_velocity(k) && std::abs(speed) > roundings[i][1])
      sides[i] = std::copysign(1.0, speed);
  }
  for (std::size_t i = 0; i < switches.size(); ++i)
    std::swap(expansion_.branch(static_cast<std::size_t>(switches[i])), sides[i]);
  try {
    expansion_.set(state);
  } catch (const convex::InvalidInput&) {
    for (std::size_t i = 0; i < switches.size(); ++i)
      expansion_.branch(static_cast<std::size_t>(switches[i])) = sides[i];
    return expansion_.set(state);
  }
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    double& df = found.rates.df[a];
    const double least = options.contact_tolerance[a] * found.rates.df_scale[a];
    if (is_two_sided(a) || !(std::abs(expansion_.rate(a) - df) > least)) continue;
    df = expansion_.rate(a);
    std::erase(found.closing, a);
    std::erase(found.present, a);
    if (found.rates.f[a] > options.contact_tolerance[a] * found.rates.f_scale[a] || df > least) continue;
    (df < -least ? found.closing : found.present).push_back(a);
  }
}

/// Of switches at 0 but for what is less than the rounding of a state on the way: those that the start itself
/// has off 0, by more than its own numbers are rounded, are on its side, unless they stay 0. Returns whether
/// there are such, which are no longer in question.
bool Motion::EventDriven::take_sides_of_start(std::vector<Index>& switches) {
  const auto is_off = [&](Index which) {
    const auto k = static_cast<std::size_t>(which);
    const double argument = expansion_.switch_argument(k)[0], part = expansion_.part_as_given();
    const bool is_beyond = std::abs(argument) > part * expansion_.rounding_of_argument(k);
    if (argument != 0 && !is_beyond)
      remark(RemarkKind::start,
             "an argument of a branch, as x of |x|, is off 0 at the start by no more than its rounding, and "
             "counts as 0",
             std::abs(argument));
    if (expansion_.branch(k) == 0 || !is_beyond) return false;
    expansion_.branch(k) = std::copysign(1.0, argument);
    arguments_[k].left_of_zero = 0;
    arguments_[k].zeros = 0;
    return true;
  };
  return std::erase_if(switches, is_off) > 0;
}

/// The difference of T - V between the branches of a switch, at the zero of its argument: events that
/// rounding does not tell apart are met at the first of them, where the argument of a later one is not 0 yet,
/// and T - V with a kink differs by as much of its slope. Branches that jump with it, none of the switches
/// themselves, go along.
double Motion::EventDriven::difference_at_zero(std::size_t k, const std::vector<Index>& switches) {
  std::vector<double> before, branches;
  for (std::size_t j = 0; j < expansion_.switches(); ++j) {
    before.push_back(arguments_[j].branch_behind);
    branches.push_back(expansion_.branch(j));
  }
  const double ahead = branches[k], behind = before[k], argument = expansion_.switch_argument(k)[0],
               speed = expansion_.switch_argument(k)[1];
  const auto difference = [&](const State& at) {
    double found = 0;
    for (const std::vector<double>& side : {std::cref(before), std::cref(branches)}) {
      for (std::size_t j = 0; j < branches.size(); ++j)
        if (j == k || !is_among(switches, static_cast<Index>(j))) expansion_.branch(j) = side[j];
      expansion_.set(at);
      found = expansion_.lagrangian() - found;
    }
    return found;
  };
  const double here = difference(state);
  if (argument == 0 || ahead == behind || speed == 0) return here;
  const double step = -argument / speed;
  const double there = difference({state.t + step, state.q + step * state.v, state.v});
  const double moved = expansion_.switch_argument(k)[0] - argument;
  expansion_.set(state);
  return moved == 0 ? here : here - argument * (there - here) / moved;
}

/// A jump of T - V over positions is an infinite force, one of p asks for a jump of the velocity that no
/// impact law tells; a jump of V over time alone is neither. Empty if there is none.
std::string Motion::EventDriven::jump_of_energy(const std::vector<Index>& contacts,
                                                const std::vector<Index>& switches) {
  const double change = expansion_.lagrangian() - behind_->lagrangian, T = system.kinetic_energy(state),
               scale = T + std::abs(T - expansion_.lagrangian()) + std::abs(T - behind_->lagrangian);
  const bool over_positions = std::any_of(switches.begin(), switches.end(), [&](Index k) {
    return expansion_.depends_on_position(static_cast<std::size_t>(k));
  });
  const auto jumps = [&](Index k) {
    return std::abs(difference_at_zero(static_cast<std::size_t>(k), switches)) > half_the_digits * scale;
  };
  if (over_positions && std::abs(change) > half_the_digits * scale) {
    if (std::any_of(switches.begin(), switches.end(), jumps))
      return "the kinetic or the potential energy jumps where one of its expressions changes its branch; no "
             "force does that; write a step of potential as a steep slope, one of mass as an impact";
    expansion_.set(state);
    expansion_.expand(question_of(contacts));
  }
  const Vector p = expansion_.momentum();
  if (!expansion_.has_branching_energy()) return "";
  const convex::Metric& A = expansion_.inertia();
  if (A.dual_norm(p - behind_->momentum) >
      half_the_digits * (A.dual_norm(p) + A.dual_norm(behind_->momentum)))
    return "the momentum ∂T/∂q' jumps where T changes its branch; what the velocity does there is not told "
           "by "
           "it; write T without a jump";
  return "";
}

bool Motion::EventDriven::meet_kinks(const std::vector<Index>& contacts, const std::vector<Index>& switches) {
  if (switches.empty()) return false;
  const std::optional<Behind> behind = behind_;
  if (behind)
    if (const std::string jump = jump_of_energy(contacts, switches); !jump.empty()) {
      stop("at t = " + number_text(state.t) + ": " + jump);
      return true;
    }
  behind_.reset();
  // What impacts at one instant, ever slower, have to tell from 0 is what the first of them found there.
  constexpr double at_once = roundings_of_instant * std::numeric_limits<double>::epsilon();
  if (left_of_f_.size() == 0 || !(since_start_ - time_of_kinks_ <= at_once * clock()))
    left_of_f_.setZero(expansion_.constraints());
  time_of_kinks_ = since_start_;
  const double least = record.steps == 0 ? 1 : 0;  // a start is known to the contact tolerance only
  const double length = record.steps == 0 ? 0 : last_length_;
  std::vector<Index> closing, opening, others, released;
  // f and df/dt of what was held are differences of two sides, each rounded by what it is the sum of.
  Expansion::Roundings roundings = expansion_.roundings_so_far();
  if (behind) {
    roundings.f += behind->roundings.f;
    roundings.rate += behind->roundings.rate;
  }
  for (Index a = 0; a < expansion_.constraints(); ++a) {
    const bool is_contact = is_among(contacts, a);
    if (is_two_sided(a) && !behind) continue;
    // What is held, or has just come to rest, is at f = df/dt = 0 on the branches behind, whatever rounding
    // makes of it.
    const bool is_leaving = zeros_of_f_[static_cast<std::size_t>(a)] > 0;
    const bool was_at_0 = behind && ((is_contact && !is_leaving) || is_two_sided(a));
    const double f = expansion_.f(a) - (was_at_0 ? behind->f[a] : 0),
                 rate = expansion_.rate(a) - (was_at_0 ? behind->rate[a] : 0);
    const double tolerance = options.contact_tolerance[a];
    const double rate_scale = expansion_.rate_scale(a);
    double& f_left = left_of_f_[a];
    f_left =
        std::max(f_left, tolerance * std::max({least, expansion_.position_scale(a), rate_scale * length}) +
                             roundings.f[a]);
    if (is_two_sided(a)) {  // holds on the branches behind
      const double rate_left = tolerance * rate_scale + roundings.rate[a];
      if (std::abs(f) > f_left) {
        stop("at t = " + number_text(state.t) + ": " + constraint_name(a) + " jumps from 0 to " +
             number_text(expansion_.f(a)) +
             " where one of its expressions changes its branch; no motion with finite velocities follows it");
        return true;
      }
      if (std::abs(rate) > rate_left) closing.push_back(a);
      continue;
    }
    if (f < -f_left && !(behind && expansion_.f(a) >= behind->f[a] - f_left)) {
      stop("at t = " + number_text(state.t) + ": " + constraint_name(a) +
           " jumps below 0 where one of its expressions changes its branch; a step is written as a wall, a "
           "contact of its own");
      return true;
    }
    if (!is_contact) continue;
    const double rate_left = tolerance * std::max(least, rate_scale) + roundings.rate[a];
    if (f > f_left || rate > rate_left) {
      opening.push_back(a);
      if (!is_leaving) released.push_back(a);
    } else
      (rate < -rate_left ? closing : others).push_back(a);
    if (f > f_left) continue;
    zeros_of_f_[static_cast<std::size_t>(a)] = rate > rate_left ? 1 : 0;
  }
  if (closing.empty() && opening.empty()) return false;
  const auto m = static_cast<long>(system.constraints().size());
  constexpr long most_kinks_at_once = 50;
  if (++kinks_at_once_ > most_kinks_at_once * (m + 1)) {
    stop("at t = " + number_text(state.t) + ": events follow each other without end at one instant" +
         advice_on_kinks());
    return true;
  }
  if (closing.empty()) {
    if (record.steps > 0 && !released.empty()) event(EventKind::release, released, state.v);
    behind_ = behind;
    begin_arc(others, switches);
    return true;
  }
  for (const Index a : opening)
    if (zeros_of_f_[static_cast<std::size_t>(a)] > 0) others.push_back(a);
  collide(closing, others, switches);
  return true;
}

/// Of these contacts those whose df/dt or gradient changes with one of these branches.
std::vector<Index> Motion::EventDriven::with_kinks(const std::vector<Index>& contacts,
                                                   const std::vector<Index>& switches) {
  std::vector<Index> found;
  if (contacts.empty() || switches.empty()) return found;
  for (const Index which : switches) {
    double& branch = expansion_.branch(static_cast<std::size_t>(which));
    const double before = branch;
    std::vector<std::pair<double, Vector>> first;
    for (const double side : {-1.0, 1.0}) {
      branch = side;
      if (!is_defined_here()) break;
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        std::pair<double, Vector> here(expansion_.rate(contacts[k]), expansion_.row(contacts[k]));
        if (side < 0)
          first.push_back(std::move(here));
        else if (first[k] != here && !is_among(found, contacts[k]))
          found.push_back(contacts[k]);
      }
    }
    branch = before;
  }
  is_defined_here();
  return found;
}

/// Multipliers that have come to 0 at the end of an arc are as far from it as the rounding of time leaves
/// them.
void Motion::EventDriven::note_unloading(const std::vector<Zero>& zeros) {
  for (const Zero& zero : zeros)
    if (zero.of == Zero::Of::multiplier)
      unloaded_.push_back(
          {zero.which, roundings_of_instant * epsilon * clock() *
                           std::abs(slope_at(coefficients(done.lambda, zero.which), done.length))});
}

}  // namespace mechanics::inline motions
