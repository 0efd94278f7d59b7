#include "cli/commands/followed_branch.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/commands/fewest_periods.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/motion_settings.hpp"
#include "mechanics/motion/orbit_section.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// The problem with another value of a parameter.
Problem with_parameter(Problem problem, const std::string& name, double value) {
  for (mechanics::NamedText& parameter : std::get<SystemProblem>(problem.content).system.parameters)
    if (parameter.name.text == name) {
      parameter.value.text = fmt::format("{}", value);
      return problem;
    }
  throw InvalidInput("--over: no parameter \"" + name + "\" in the file; name one of [system.parameters]");
}

double distance(const mechanics::State& x, const mechanics::State& y) {
  return std::hypot((x.q - y.q).norm(), (x.v - y.v).norm());
}

/// Orbits that a polynomial goes through.
constexpr std::size_t most_of_trail = 5;

/// The first orbit is a fold itself if that is no further from it than this part of a step.
constexpr double at_fold = 1e-8;

}  // namespace

std::string FollowedBranch::follow() {
  const Problem first = with_parameter(problem_, range_.parameter, range_.first);
  const auto& text = std::get<SystemProblem>(first.content);
  const mechanics::State guess = mechanics::lagrangian_system(text.system)->state(text.state);
  t_ = guess.t;
  constexpr int most_turns = 16;
  int turns = 0;
  Progress progress(static_cast<int>(range_.count()));
  long reached = 0;
  for (long k = 0; k >= 0 && k < range_.count(); k += forward_) {
    const double value = range_.value(k);
    for (; reached < k; ++reached) progress.step();
    progress.now(fmt::format("{} = {}", range_.parameter, value));
    if (Progress::interrupted()) return fmt::format("interrupted before {} = {}", range_.parameter, value);
    std::optional<Station> next = last_ ? attempt_from_last(value) : attempt(value, guess, 0);
    if (next && !last_) {
      trail_ = {*next};
      begin(*next);
      continue;
    }
    if (next && periods_of(*next) < options_.periods && periods_of(*last_) == options_.periods)
      return fmt::format(
          "the branch ends between {} = {} and {}, in the flip of an orbit of fewer periods; for that one "
          "give a "
          "smaller --periods",
          range_.parameter, last_->value, value);
    if (next) {
      arrive(*next);
      if (is_lost_)
        return fmt::format("the branch ends before {} = {}: the nearest orbit there is of another branch",
                           range_.parameter, value);
      continue;
    }
    const bool may_turn = trail_.size() > 1 && ++turns <= most_turns;
    bool is_on = false;
    if (may_turn && turn(value)) {
      forward_ = -forward_;
      if (!begin_behind_fold(range_.value(k + forward_)))
        return fmt::format("the branch turns at {} = {}; its other side is not found", range_.parameter,
                           fold_->value);
    } else if (const int before = forward_; may_turn && graze(value, is_on)) {
      if (!is_on)
        return fmt::format("the branch ends at {} = {}: {}", range_.parameter, points_.back().value, why_);
      if (forward_ == before) k -= forward_;  // the same value again
    } else {
      return fmt::format("the branch ends before {} = {}: {}", range_.parameter, value, why_);
    }
  }
  return "";
}

mechanics::OrbitQuestion FollowedBranch::question(const mechanics::LagrangianSystem& system,
                                                  double value) const {
  const Problem at = with_parameter(problem_, range_.parameter, value);
  mechanics::OrbitQuestion asked = asked_;
  asked.motion.restitution = restitutions(at, system);
  if (asked.is_free)
    asked.energy = system.energy(system.state(std::get<SystemProblem>(at.content).state));
  else
    asked.period = value_of(at, system, *options_.period, "--period") * static_cast<double>(options_.periods);
  return asked;
}

std::optional<FollowedBranch::Station> FollowedBranch::attempt(double value, const mechanics::State& guess,
                                                               double period) {
  if (flown_ > most_flown) {
    why_ =
        "orbits were sought beside it in vain, for long: events crowd there, as grazes do where impacts "
        "cease to accumulate; begin at an orbit beyond it";
    return std::nullopt;
  }
  flown_ += 1 + (trail_.empty() ? 0 : trail_.back().orbit.impacts.size());
  try {
    const auto system = family().system(value);
    mechanics::OrbitQuestion asked = question(*system, value);
    if (asked.is_free) asked.period = period;
    Station found{value, mechanics::find_orbit(*system, guess, asked)};
    if (found.orbit.is_found) return found;
    why_ = found.orbit.why;
  } catch (const InvalidInput& error) {
    why_ = error.what();
  }
  return std::nullopt;
}

std::optional<FollowedBranch::Station> FollowedBranch::attempt_along(const Station& a, const Station& b,
                                                                     double value) {
  const double part = (value - a.value) / (b.value - a.value);
  mechanics::State guess = a.orbit.start;
  guess.q += part * (b.orbit.start.q - a.orbit.start.q);
  guess.v += part * (b.orbit.start.v - a.orbit.start.v);
  return attempt(value, guess, b.orbit.period);
}

/// Neville's scheme.
std::optional<FollowedBranch::Station> FollowedBranch::attempt_by_polynomial(
    const std::vector<Station>& through, double value) {
  const std::size_t count = std::min(through.size(), most_of_trail), first = through.size() - count;
  std::vector<mechanics::State> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(through[first + i].orbit.start);
  for (std::size_t width = 1; width < count; ++width)
    for (std::size_t i = 0; i + width < count; ++i) {
      const double from = through[first + i].value, to = through[first + i + width].value;
      if (from == to) return std::nullopt;
      const double part = (value - from) / (to - from);
      x[i].q += part * (x[i + 1].q - x[i].q);
      x[i].v += part * (x[i + 1].v - x[i].v);
    }
  return attempt(value, x[0], through.back().orbit.period);
}

mechanics::OrbitFamily FollowedBranch::family() const {
  return {[this](double value) {
            const Problem at = with_parameter(problem_, range_.parameter, value);
            return mechanics::lagrangian_system(std::get<SystemProblem>(at.content).system);
          },
          [this](const mechanics::LagrangianSystem& system, double value) { return question(system, value); },
          std::abs(range_.last - range_.first) + std::abs(range_.step)};
}

FollowedBranch::Station FollowedBranch::moved(const Station& from, double t) const {
  const auto system = family().system(from.value);
  return {from.value, mechanics::orbit_from(*system, from.orbit, question(*system, from.value), t)};
}

void FollowedBranch::choose_instant() {
  constexpr double still_quiet = 0.3;
  const mechanics::Orbit& orbit = trail_.back().orbit;
  if (orbit.start_margin >= still_quiet * orbit.quiet_margin) return;
  double t = orbit.quiet.t;
  while (t >= t_ + orbit.period) t -= orbit.period;
  for (Station& station : trail_) station = moved(station, t);
  if (last_) last_ = moved(*last_, t);
}

bool FollowedBranch::follows(const Station& next) const {
  if (trail_.size() < 2) return true;
  const Station &last = trail_.back(), &before = trail_[trail_.size() - 2];
  const double usual = distance(last.orbit.start, before.orbit.start) *
                       std::abs((next.value - last.value) / (last.value - before.value));
  constexpr double factor = 4, least = 1e-6;  // 2.4 into a fold
  // An orbit may begin at 0: what is little beside how far it goes, not beside its start, is rounding.
  const double size = last.orbit.largest.norm();
  const double away = distance(next.orbit.start, last.orbit.start);
  if (away <= least * size) return true;
  const double onward =  // a branch does not turn about between two values
      (next.orbit.start.q - last.orbit.start.q).dot(last.orbit.start.q - before.orbit.start.q) +
      (next.orbit.start.v - last.orbit.start.v).dot(last.orbit.start.v - before.orbit.start.v);
  const bool same_way = (next.value - last.value) * (last.value - before.value) > 0;
  return away <= factor * usual + least * size && (same_way ? onward > 0 : onward < 0);
}

bool FollowedBranch::has_its_impacts(const Station& next) {
  const Station last = trail_.back();
  const bool opens = opened_contact(last.orbit, next.orbit) >= 0;
  if ((!opens && grazed(last, next) < 0) || !last.orbit.multipliers || !next.orbit.multipliers) return true;
  BranchEvent event = opens ? BranchEvent::opening : BranchEvent::grazing;
  const bool is_behind_graze = locate(last, next, event).has_value();
  is_lost_ = false;
  return is_behind_graze;
}

std::optional<FollowedBranch::Station> FollowedBranch::attempt_from_last(double value, int depth) {
  const Station last = trail_.back();
  std::optional<Station> found;
  if (trail_.size() > 1) {
    found = attempt_along(trail_[trail_.size() - 2], last, value);
    if (found && !(follows(*found) && has_its_impacts(*found))) found.reset();
    if (!found && trail_.size() > 2) found = attempt_by_polynomial(trail_, value);
    if (found && !(follows(*found) && has_its_impacts(*found))) found.reset();
  }
  if (!found) found = attempt(value, last.orbit.start, last.orbit.period);
  if (found && !(follows(*found) && has_its_impacts(*found))) {
    why_ = "the nearest orbit there is of another branch";
    found.reset();
  }
  if (!found && depth < deepest && trail_.size() > 1) {
    const std::vector<Station> kept = trail_;
    if (attempt_from_last(0.5 * (last.value + value), depth + 1)) found = attempt_from_last(value, depth + 1);
    if (!found) trail_ = kept;
    return found;
  }
  if (found) {
    trail_.push_back(*found);
    if (trail_.size() > most_of_trail) trail_.erase(trail_.begin());
    choose_instant();
    found = trail_.back();
  }
  return found;
}

long FollowedBranch::periods_of(const Station& at) const {
  const auto system = family().system(at.value);
  return fewest_periods(*system, at.orbit, question(*system, at.value), options_.periods);
}

void FollowedBranch::row(const Station& at, BranchEvent event) {
  flown_ = 0;
  const mechanics::Orbit& orbit = at.orbit;
  const mechanics::Orbit told = moved(at, t_).orbit;
  table_ += fmt::format("{},{},{},{},{},{},{},{}\n", at.value, orbit.period,
                        orbit.multipliers ? (orbit.is_stable ? "1" : "0") : "",
                        orbit.multipliers ? fmt::format("{}", std::abs(orbit.multipliers->front())) : "",
                        orbit.impacts.size(), table_name(event), fmt::join(told.start.q, ","),
                        fmt::join(told.start.v, ","));
  points_.push_back({at.value, told, event_name(event)});
  if (event == BranchEvent::branching)
    remarks_.push_back(fmt::format(
        "at {} = {} a multiplier passes 1 and the branch does not turn: another branch crosses it "
        "there, as where a symmetry breaks",
        range_.parameter, at.value));
}

void FollowedBranch::begin(const Station& first) {
  BranchEvent event = BranchEvent::none;
  const double step = std::abs(range_.step);
  if (const auto fold = mechanics::find_turning_point(family(), first.value, first.orbit, step))
    if (std::abs(fold->value - first.value) <= at_fold * step) event = BranchEvent::fold;
  row(first, event);
  if (const long fewest = periods_of(first); fewest < options_.periods)
    remarks_.push_back(
        fmt::format("its orbits come back after {} of the {} periods already; give --periods {}", fewest,
                    options_.periods, fewest));
  last_ = first;
  ++count_;
  choose_instant();
}

void FollowedBranch::arrive(const Station& next) {
  constexpr int most_events_in_step = 8;
  BranchEvent event = BranchEvent::none;
  Station from = *last_;
  const bool is_on_it = !next.orbit.multipliers;
  if (is_on_it && from.orbit.multipliers) event = BranchEvent::grazing;
  for (int i = 0; i < most_events_in_step && !is_on_it && from.orbit.multipliers; ++i) {
    event = event_between(from.orbit, next.orbit, asked_.is_free);
    if (event == BranchEvent::none) break;
    const std::optional<Passage> passage = locate(from, next, event);
    if (is_lost_) return;
    if (passage) {
      if (event != BranchEvent::none) row(passage->at, event);
      from = passage->behind;
    } else {
      remarks_.push_back(
          fmt::format("between {0} = {1} and {2} {3}; at which {0} is not found: take shorter steps",
                      range_.parameter, from.value, next.value,
                      event == BranchEvent::grazing ? "the number of impacts changes"
                                                    : "a " + std::string(event_name(event)) + " lies"));
    }
    event = BranchEvent::none;
    if (!passage) break;
  }
  row(next, event);
  last_ = next;
  ++count_;
}

}  // namespace cli::inline commands
