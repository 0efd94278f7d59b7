#include "cli/measurement/motion_exams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "mechanics/lagrangian_system.hpp"

namespace cli::inline measurement {
namespace {

using convex::Index;
using convex::Vector;
using mechanics::MotionMethod;
using Real = long double;

constexpr Real gravity = 9.81L;

/// A ball that falls from rest at h, at time t: its height.
Real height_of_ball(Real h, Real e, Real t) {
  Real speed = std::sqrt(2 * gravity * h), left = t - std::sqrt(2 * h / gravity);
  if (left < 0) return h - gravity * t * t / 2;
  for (speed *= e; left > 2 * speed / gravity; speed *= e) {
    left -= 2 * speed / gravity;
    if (speed < 1e-30L) return 0;
  }
  return speed * left - gravity * left * left / 2;
}

double away(Real found, Real truth, Real scale = 1) {
  return static_cast<double>(std::abs(found - truth) / scale);
}

MotionOutcome followed(const mechanics::LagrangianSystem& system, const MotionExam& exam,
                       const mechanics::MotionOptions& options) {
  mechanics::Motion motion(system, exam.start, options);
  MotionOutcome outcome;
  const auto look = [&] {
    for (const mechanics::MotionEvent& event : motion.events())
      if (event.kind == mechanics::EventKind::accumulation && outcome.accumulation == 0)
        outcome.accumulation = event.t;
  };
  look();
  while (motion.advance(exam.until)) look();
  outcome.status = motion.status();
  outcome.end = motion.state();
  outcome.energy = motion.energy();
  outcome.record = motion.record();
  return outcome;
}

/// Numbers of which a closed form has no more digits.
constexpr double least_claim = 1e-13;

}  // namespace

std::vector<std::string> integrator_names() { return {"event-driven", "time-stepping"}; }

std::vector<Contest> motion_contests(MotionExam asked, long steps) {
  const auto exam = std::make_shared<const MotionExam>(std::move(asked));
  const std::shared_ptr<const mechanics::LagrangianSystem> system = mechanics::lagrangian_system(exam->text);
  const auto rows = static_cast<Index>(system->constraints().size());
  std::vector<Contest> all;
  for (const MotionMethod method : {MotionMethod::event_driven, MotionMethod::time_stepping}) {
    const bool by_events = method == MotionMethod::event_driven;
    const auto outcome = std::make_shared<MotionOutcome>();
    const auto bound = std::make_shared<double>(0);
    Contest contest;
    contest.problem = exam->name;
    contest.n = exam->start.q.size();
    contest.m = rows;
    contest.method = name(method);
    contest.kind = convex::MethodKind::iterative;
    if (!by_events && exam->needs_events) contest.refused = "time-stepping has no such event";
    contest.work = [=](const convex::Accuracy& accuracy) {
      mechanics::MotionOptions options;
      options.method = method;
      options.tolerance = accuracy.tolerance;
      options.step = steps > 0 ? exam->until / static_cast<double>(steps) : accuracy.tolerance;
      options.restitution = Vector::Constant(rows, exam->restitution);
      *outcome = followed(*system, *exam, options);
      *bound = by_events ? std::max(accuracy.tolerance, least_claim) * exam->growth
                         : std::numeric_limits<double>::infinity();
    };
    contest.judged = [=] {
      Judgement judgement;
      judgement.bound = *bound;
      if (outcome->status != mechanics::MotionStatus::done) {
        judgement.verdict = Verdict::gave_up;
        return judgement;
      }
      judgement.error = exam->error(*outcome);
      if (exceeds(judgement.error, judgement.bound))
        judgement.verdict = outcome->record.remarks.empty() ? Verdict::wrong : Verdict::gave_up;
      return judgement;
    };
    all.push_back(std::move(contest));
  }
  return all;
}

MotionExam falling_ball(double until) {
  constexpr double e = 0.9;
  MotionExam exam;
  exam.name = fmt::format("ball with e 0.9 to t {:g}", until);
  exam.text.coordinates = {{"y", {}}};
  exam.text.kinetic = {"y'^2/2", {}};
  exam.text.potential = mechanics::Text{"9.81*y", {}};
  exam.text.constraints = {{{"floor", {}}, {"y >= 0", {}}}};
  exam.start = {0, Vector{{1}}, Vector{{0}}};
  exam.restitution = e;
  exam.until = until;
  exam.growth = 10;  // speeds of a few units, times as many times of impacts
  exam.error = [until](const MotionOutcome& found) {
    return away(found.end.q[0], height_of_ball(1, e, until));
  };
  return exam;
}

MotionExam stopped_oscillator(double until) {
  constexpr double e = 0.8;
  MotionExam exam;
  exam.name = fmt::format("oscillator with a stop to t {:g}", until);
  exam.text.coordinates = {{"x", {}}};
  exam.text.kinetic = {"x'^2/2", {}};
  exam.text.potential = mechanics::Text{"x^2/2", {}};
  exam.text.constraints = {{{"stop", {}}, {"x >= 0", {}}}};
  exam.start = {0, Vector{{1}}, Vector{{0}}};
  exam.restitution = e;
  exam.until = until;
  exam.growth = 10;
  exam.error = [until](const MotionOutcome& found) {
    const Real t = until;
    const Real impacts = std::floor(t / std::numbers::pi_v<Real> + 0.5L);
    return away(found.end.q[0], std::pow(Real{e}, impacts) * std::abs(std::cos(t)));
  };
  return exam;
}

MotionExam kepler_orbit(int periods) {
  MotionExam exam;
  exam.name = periods == 1 ? "Kepler orbit for 1 period" : fmt::format("Kepler orbit for {} periods", periods);
  exam.text.coordinates = {{"x", {}}, {"y", {}}};
  exam.text.kinetic = {"(x'^2 + y'^2)/2", {}};
  exam.text.potential = mechanics::Text{"-1/sqrt(x^2 + y^2)", {}};
  exam.start = {0, Vector{{0.5, 0}}, Vector{{0, std::sqrt(3.0)}}};
  exam.until = 2 * std::numbers::pi * periods;
  // An error of the energy turns into one of the period, and this adds up.
  exam.growth = 100.0 * periods * periods;
  exam.error = [](const MotionOutcome& found) {
    return std::hypot(away(found.end.q[0], 0.5L), away(found.end.q[1], 0));
  };
  return exam;
}

MotionExam many_balls(int count) {
  constexpr double e = 0.5;
  MotionExam exam;
  exam.name = count == 1 ? "1 ball for 1 s" : fmt::format("{} balls for 1 s", count);
  exam.text.coordinates = {{"y[1..N]", {}}};
  exam.text.parameters = {{{"N", {}}, {std::to_string(count), {}}}};
  exam.text.kinetic = {"sum(i in 1..N, y[i]'^2/2)", {}};
  exam.text.potential = mechanics::Text{"sum(i in 1..N, 9.81*y[i])", {}};
  exam.text.constraints = {{{"floor[i in 1..N]", {}}, {"y[i] >= 0", {}}}};
  Vector heights(count);
  for (Index i = 0; i < count; ++i) heights[i] = 1 + static_cast<double>(i) / count;
  exam.start = {0, heights, Vector::Zero(count)};
  exam.restitution = e;
  exam.until = 1;
  exam.growth = 10;
  exam.error = [heights](const MotionOutcome& found) {
    double worst = 0;
    for (Index i = 0; i < heights.size(); ++i)
      worst = std::max(worst, away(found.end.q[i], height_of_ball(heights[i], e, 1)));
    return worst;
  };
  return exam;
}

}  // namespace cli::inline measurement
