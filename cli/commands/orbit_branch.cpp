#include "cli/commands/orbit_branch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "cli/commands/branch_event.hpp"
#include "cli/commands/branch_range.hpp"
#include "cli/drawing/branch_drawing.hpp"
#include "cli/motion_settings.hpp"
#include "cli/report/json_writer.hpp"
#include "mechanics/motion/turning_point.hpp"

namespace cli {
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

/// An orbit of the branch, at a value of the parameter.
struct Station {
  double value = 0;
  mechanics::Orbit orbit;
};

/// The state between, or beyond, two orbits of a branch, in proportion to the parameter.
mechanics::State in_proportion(const Station& a, const Station& b, double value) {
  const double part = (value - a.value) / (b.value - a.value);
  mechanics::State state = a.orbit.start;
  state.q += part * (b.orbit.start.q - a.orbit.start.q);
  state.v += part * (b.orbit.start.v - a.orbit.start.v);
  return state;
}

/// A fold is that of the last orbits if it is no further from them than this part of a step.
constexpr double near_fold = 1e-2;

/// The first orbit is a fold itself if that is no further from it than this part of a step.
constexpr double at_fold = 1e-8;

/// Follows a branch of orbits over a parameter, with the values at which something happens on it.
class Branch {
 public:
  Branch(const Problem& problem, const mechanics::OrbitQuestion& asked, const OrbitOptions& options,
         BranchRange range)
      : problem_(problem), asked_(asked), options_(options), range_(std::move(range)) {}

  /// Why it ends before the range does, or nothing.
  std::string follow() {
    const Problem first = with_parameter(problem_, range_.parameter, range_.first);
    const auto& text = std::get<SystemProblem>(first.content);
    const mechanics::State guess = mechanics::lagrangian_system(text.system)->state(text.state);
    constexpr int most_turns = 16;
    int turns = 0;
    for (long k = 0; k >= 0 && k < range_.count(); k += forward_) {
      const double value = range_.value(k);
      const std::optional<Station> next =
          stations_.empty() ? attempt(value, guess, 0) : attempt_from_last(value);
      if (next && stations_.empty()) {
        trail_ = {*next};
        begin(*next);
      } else if (next) {
        arrive(*next);
      } else if (++turns <= most_turns && trail_.size() > 1 && turn(value)) {
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
  const std::string& table() const { return table_; }
  const std::vector<BranchPoint>& points() const { return points_; }
  long count() const { return static_cast<long>(stations_.size()); }

 private:
  std::optional<Station> attempt(double value, const mechanics::State& guess, double period) {
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

  mechanics::OrbitFamily family() const {
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

  /// Whether an orbit is where the last two lead; if not, Newton's method went to another branch.
  bool follows(const Station& next) const {
    if (trail_.size() < 2) return true;
    const Station &last = trail_.back(), &before = trail_[trail_.size() - 2];
    const auto distance = [](const Station& x, const Station& y) {
      return std::hypot((x.orbit.start.q - y.orbit.start.q).norm(),
                        (x.orbit.start.v - y.orbit.start.v).norm());
    };
    const double usual =
        distance(last, before) * std::abs((next.value - last.value) / (last.value - before.value));
    constexpr double factor = 4, least = 1e-6;  // 2.4 into a fold
    const double size = std::hypot(last.orbit.start.q.norm(), last.orbit.start.v.norm());
    const double away = distance(next, last);
    if (away <= least * size) return true;
    const double onward =  // a branch does not turn about between two values
        (next.orbit.start.q - last.orbit.start.q).dot(last.orbit.start.q - before.orbit.start.q) +
        (next.orbit.start.v - last.orbit.start.v).dot(last.orbit.start.v - before.orbit.start.v);
    const bool same_way = (next.value - last.value) * (last.value - before.value) > 0;
    return away <= factor * usual + least * size && (same_way ? onward > 0 : onward < 0);
  }

  /// The orbit at a value from the last ones, with shorter steps between where these lead elsewhere.
  std::optional<Station> attempt_from_last(double value, int depth = 0) {
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
      if (attempt_from_last(0.5 * (last.value + value), depth + 1))
        found = attempt_from_last(value, depth + 1);
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

  void row(const Station& at, const std::string& event) {
    const mechanics::Orbit& orbit = at.orbit;
    table_ += fmt::format("{},{},{},{},{},{}\n", at.value, orbit.period,
                          orbit.multipliers ? (orbit.is_stable ? "1" : "0") : "",
                          orbit.multipliers ? fmt::format("{}", std::abs(orbit.multipliers->front())) : "",
                          orbit.impacts.size(), event);
    points_.push_back({at.value, orbit, event});
  }

  /// The first orbit, which may be a fold itself.
  void begin(const Station& first) {
    std::string event;
    if (!asked_.is_free)
      if (const auto fold = mechanics::find_turning_point(family(), first.value, first.orbit))
        if (std::abs(fold->value - first.value) <= at_fold * std::abs(range_.step)) event = "fold";
    row(first, event);
    stations_.push_back(first);
  }

  /// The next orbit, and before it those at which something happens on the way, each in a row of its own.
  void arrive(const Station& next) {
    constexpr int most_events_in_step = 4;
    std::string event;
    if (!stations_.empty()) {
      Station from = stations_.back();
      for (int i = 0; i < most_events_in_step; ++i) {
        event = event_between(from.orbit, next.orbit);
        if (event.empty()) break;
        const std::optional<Station> there = locate(from, next, event);
        if (!there) break;  // told in the row after it
        row(*there, event);
        from = *there;
        event.clear();
      }
    }
    row(next, event);
    stations_.push_back(next);
  }

  /// The orbit just past an event between two, by bisection; `event` is the first one.
  std::optional<Station> locate(Station a, Station b, std::string& event) {
    constexpr double close = 1e-11;
    const double step = std::abs(range_.step);
    bool is_located = false;
    while (std::abs(b.value - a.value) > close * step) {
      const double middle = 0.5 * (a.value + b.value);
      if (middle == a.value || middle == b.value) break;
      auto found = attempt(middle, in_proportion(a, b, middle), 0.5 * (a.orbit.period + b.orbit.period));
      if (!found) found = attempt(middle, a.orbit.start, a.orbit.period);
      if (!found) break;
      const std::string here = event_between(a.orbit, found->orbit);
      if (here.empty()) {
        a = std::move(*found);
      } else {
        event = here;
        b = std::move(*found);
        is_located = true;
      }
    }
    constexpr double near = 1e-3;  // part of a step: else it is not known well enough for a row
    if (!is_located && std::abs(b.value - a.value) > near * step) return std::nullopt;
    return b;
  }

  /// Whether the branch turns around before a value at which it has no orbit. If so, the fold is told, and
  /// `fold_` is what finds orbits behind it.
  bool turn(double beyond) {
    if (asked_.is_free) return false;  // one multiplier is 1 anyhow
    Station near = trail_.back();
    double none = beyond;
    constexpr int halvings = 10;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (near.value + none);
      if (auto found = attempt_from_last(middle))
        near = std::move(*found);
      else
        none = middle;
    }
    fold_ = mechanics::find_turning_point(family(), near.value, near.orbit);
    const double apart = fold_ ? std::abs(fold_->value - none) : 0;
    if (!fold_ || apart > std::abs(none - near.value) + near_fold * std::abs(range_.step)) return false;
    const Station& last = trail_.front();
    if (along(last.orbit.start, fold_->orbit.start) < 0) fold_->along = -fold_->along;
    row({fold_->value, fold_->orbit}, "fold");
    return true;
  }

  /// How far `to` is from `from` in the direction of the branch at the fold.
  double along(const mechanics::State& from, const mechanics::State& to) const {
    const convex::Index n = from.q.size();
    return fold_->along.head(n).dot(to.q - from.q) + fold_->along.tail(n).dot(to.v - from.v);
  }

  /// Two orbits on the other side of the fold, so near it that the branch is nearly a parabola, and no
  /// further than `value`.
  bool begin_behind_fold(double value) {
    const double reach = std::min(std::abs(fold_->value - value), 0.05 * std::abs(range_.step));
    // The parabola from the side that we came from.
    Station from = trail_.back();
    if (std::abs(fold_->value - from.value) < 1e-6 * reach) from = trail_.front();
    const double before = along(from.orbit.start, fold_->orbit.start);
    const double curvature = std::abs(fold_->value - from.value) / (before * before);
    const double distance = std::sqrt(reach / curvature);
    if (!(distance > 0) || !std::isfinite(distance)) return false;
    const auto one = orbit_beside(family(), *fold_, 0.5 * distance),
               four = orbit_beside(family(), *fold_, distance);
    if (!one || !four) return false;
    trail_ = {{one->value, one->orbit}, {four->value, four->orbit}};
    stations_.push_back(trail_.back());
    row(trail_.back(), "");
    return (four->value - one->value) * way() > 0;
  }

  /// In which direction the parameter goes.
  double way() const { return range_.step > 0 ? forward_ : -forward_; }

  const Problem& problem_;
  const mechanics::OrbitQuestion& asked_;
  const OrbitOptions& options_;
  BranchRange range_;
  std::vector<Station> stations_;  // in the table
  std::vector<Station> trail_;     // the last two, those between values of the range too
  std::string table_, why_;
  std::vector<BranchPoint> points_;
  int forward_ = 1;                              // -1 behind a fold
  std::optional<mechanics::TurningPoint> fold_;  // the last one
};

}  // namespace

Answer orbit_branch(const std::string& file, const Problem& problem, const mechanics::OrbitQuestion& asked,
                    const OrbitOptions& options) {
  const BranchRange range = branch_range(*options.over);
  if (options.plot) require_drawable(*options.plot);
  Branch branch(problem, asked, options, range);
  const std::string why = branch.follow();
  const std::string table =
      range.parameter + ",period,stable,largest_multiplier,impacts,event\n" + branch.table();
  const long found = branch.count();
  if (options.output) {
    std::ofstream out(*options.output, std::ios::binary);
    out << table;
    out.close();
    if (!out)
      throw InvalidInput("cannot write " + *options.output + "; check the folder and its permissions");
  }
  if (options.plot && !branch.points().empty()) {
    const auto system = mechanics::lagrangian_system(std::get<SystemProblem>(problem.content).system);
    draw(*options.plot,
         branch_drawing(branch.points(), system->coordinates(), range.parameter, problem.title));
  }
  Answer answer{why.empty() ? Exit::solved : Exit::inaccurate, {}};
  if (options.json) {
    JsonWriter json;
    json.begin_object().key("file").value(file).key("kind").value("orbit");
    json.key("status")
        .value(why.empty() ? "solved" : "gave-up")
        .key("orbits")
        .value(static_cast<convex::Index>(found));
    if (!why.empty()) json.key("why").value(why);
    answer.text = json.end_object().text() + "\n";
  } else {
    answer.text =
        options.output || options.plot ? fmt::format("{} orbits over {}.\n", found, range.parameter) : table;
  }
  if (!why.empty()) answer.warnings.push_back(why);
  return answer;
}

}  // namespace cli
