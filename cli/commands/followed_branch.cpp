#include "cli/commands/followed_branch.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/commands/branch_event.hpp"
#include "cli/motion_settings.hpp"

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

/// The state between, or beyond, two orbits of a branch, in proportion to the parameter.
template <class Station>
mechanics::State in_proportion(const Station& a, const Station& b, double value) {
  const double part = (value - a.value) / (b.value - a.value);
  mechanics::State state = a.orbit.start;
  state.q += part * (b.orbit.start.q - a.orbit.start.q);
  state.v += part * (b.orbit.start.v - a.orbit.start.v);
  return state;
}

double distance(const mechanics::State& x, const mechanics::State& y) {
  return std::hypot((x.q - y.q).norm(), (x.v - y.v).norm());
}

/// States of one branch at values that agree to ten digits differ by less than this part.
constexpr double jump = 1e-2;

/// The first orbit is a fold itself if that is no further from it than this part of a step.
constexpr double at_fold = 1e-8;

}  // namespace

std::string FollowedBranch::follow() {
  const Problem first = with_parameter(problem_, range_.parameter, range_.first);
  const auto& text = std::get<SystemProblem>(first.content);
  const mechanics::State guess = mechanics::lagrangian_system(text.system)->state(text.state);
  constexpr int most_turns = 16;
  int turns = 0;
  for (long k = 0; k >= 0 && k < range_.count(); k += forward_) {
    const double value = range_.value(k);
    std::optional<Station> next = stations_.empty() ? attempt(value, guess, 0) : attempt_from_last(value);
    if (!next && trail_.size() > 1 && ++turns <= most_turns && across_start(value)) {
      k -= forward_;  // the same value again
      continue;
    }
    if (next && stations_.empty()) {
      trail_ = {*next};
      begin(*next);
    } else if (next) {
      arrive(*next);
      if (is_lost_)
        return fmt::format("the branch ends before {} = {}: the nearest orbit there is of another branch",
                           range_.parameter, value);
    } else if (turns <= most_turns && trail_.size() > 1 && turn(value)) {
      forward_ = -forward_;
      if (!begin_behind_fold(range_.value(k + forward_)))
        return fmt::format("the branch turns at {} = {}; its other side is not found", range_.parameter,
                           fold_->value);
    } else {
      return fmt::format("the branch ends before {} = {}: {}", range_.parameter, value, why_);
    }
  }
  return "";
}

std::optional<FollowedBranch::Station> FollowedBranch::attempt(double value, const mechanics::State& guess,
                                                               double period) {
  const Problem at = with_parameter(problem_, range_.parameter, value);
  const auto system = mechanics::lagrangian_system(std::get<SystemProblem>(at.content).system);
  mechanics::OrbitQuestion question = asked_;
  question.period = question.is_free ? period
                                     : value_of(at, *system, *options_.period, "--period") *
                                           static_cast<double>(options_.periods);
  try {
    Station found{value, mechanics::find_orbit(*system, guess, question)};
    if (found.orbit.is_found) return found;
    why_ = found.orbit.why;
  } catch (const InvalidInput& error) {
    why_ = error.what();
  }
  return std::nullopt;
}

mechanics::OrbitFamily FollowedBranch::family() const {
  const auto at = [this](double value) { return with_parameter(problem_, range_.parameter, value); };
  return {[at](double value) {
            return mechanics::lagrangian_system(std::get<SystemProblem>(at(value).content).system);
          },
          [at, this](const mechanics::LagrangianSystem& system, double value) {
            mechanics::OrbitQuestion question = asked_;
            if (!question.is_free)
              question.period = value_of(at(value), system, *options_.period, "--period") *
                                static_cast<double>(options_.periods);
            return question;
          }};
}

bool FollowedBranch::follows(const Station& next) const {
  if (trail_.size() < 2) return true;
  const Station &last = trail_.back(), &before = trail_[trail_.size() - 2];
  const double usual = distance(last.orbit.start, before.orbit.start) *
                       std::abs((next.value - last.value) / (last.value - before.value));
  constexpr double factor = 4, least = 1e-6;  // 2.4 into a fold
  const double size = std::hypot(last.orbit.start.q.norm(), last.orbit.start.v.norm());
  const double away = distance(next.orbit.start, last.orbit.start);
  if (away <= least * size) return true;
  const double onward =  // a branch does not turn about between two values
      (next.orbit.start.q - last.orbit.start.q).dot(last.orbit.start.q - before.orbit.start.q) +
      (next.orbit.start.v - last.orbit.start.v).dot(last.orbit.start.v - before.orbit.start.v);
  const bool same_way = (next.value - last.value) * (last.value - before.value) > 0;
  return away <= factor * usual + least * size && (same_way ? onward > 0 : onward < 0);
}

std::optional<FollowedBranch::Station> FollowedBranch::attempt_from_last(double value, int depth) {
  constexpr int deepest = 8;
  const Station last = trail_.back();
  std::optional<Station> found;
  if (trail_.size() > 1) {
    found = attempt(value, in_proportion(trail_[trail_.size() - 2], last, value), last.orbit.period);
    if (found && !follows(*found)) found.reset();
  }
  if (!found) found = attempt(value, last.orbit.start, last.orbit.period);
  if (found && !follows(*found)) {
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
    constexpr std::size_t enough = 2;
    if (trail_.size() > enough) trail_.erase(trail_.begin());
  }
  return found;
}

void FollowedBranch::row(const Station& at, const std::string& event) {
  const mechanics::Orbit& orbit = at.orbit;
  table_ += fmt::format("{},{},{},{},{},{}\n", at.value, orbit.period,
                        orbit.multipliers ? (orbit.is_stable ? "1" : "0") : "",
                        orbit.multipliers ? fmt::format("{}", std::abs(orbit.multipliers->front())) : "",
                        orbit.impacts.size(), event);
  points_.push_back({at.value, orbit, event});
}

void FollowedBranch::begin(const Station& first) {
  std::string event;
  if (!asked_.is_free)
    if (const auto fold = mechanics::find_turning_point(family(), first.value, first.orbit))
      if (std::abs(fold->value - first.value) <= at_fold * std::abs(range_.step)) event = "fold";
  row(first, event);
  stations_.push_back(first);
}

void FollowedBranch::arrive(const Station& next) {
  constexpr int most_events_in_step = 4;
  std::string event;
  if (!stations_.empty()) {
    Station from = stations_.back();
    for (int i = 0; i < most_events_in_step; ++i) {
      event = event_between(from.orbit, next.orbit, asked_.is_free);
      if (event.empty()) break;
      const std::optional<Station> there = locate(from, next, event);
      if (is_lost_) return;
      if (!there) break;  // told in the row after it
      row(*there, event);
      from = *there;
      event.clear();
    }
  }
  row(next, event);
  stations_.push_back(next);
}

std::optional<FollowedBranch::Station> FollowedBranch::locate(Station a, Station b, std::string& event) {
  constexpr double close = 1e-11;
  const double step = std::abs(range_.step);
  bool is_located = false;
  while (std::abs(b.value - a.value) > close * step) {
    const double middle = 0.5 * (a.value + b.value);
    if (middle == a.value || middle == b.value) break;
    auto found = attempt(middle, in_proportion(a, b, middle), 0.5 * (a.orbit.period + b.orbit.period));
    if (!found) found = attempt(middle, a.orbit.start, a.orbit.period);
    if (!found) break;
    const std::string here = event_between(a.orbit, found->orbit, asked_.is_free);
    if (here.empty()) {
      a = std::move(*found);
    } else {
      event = here;
      b = std::move(*found);
      is_located = true;
    }
  }
  // A branch is one curve: what jumps between two values that are one but for rounding is not an event of it.
  const double away = distance(a.orbit.start, b.orbit.start);
  is_lost_ = is_located && away > jump * std::hypot(b.orbit.start.q.norm(), b.orbit.start.v.norm());
  if (is_lost_) return std::nullopt;
  constexpr double near = 1e-3;  // part of a step: else it is not known well enough for a row
  if (!is_located && std::abs(b.value - a.value) > near * step) return std::nullopt;
  return b;
}

}  // namespace cli::inline commands
