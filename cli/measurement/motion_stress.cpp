#include "cli/measurement/motion_stress.hpp"

#include <cmath>
#include <numbers>

#include "cli/measurement/motion_exams.hpp"

namespace cli::inline measurement {
namespace {

using convex::Vector;
using Real = long double;

constexpr double stressed_gravity = 9.81;

/// Time-stepping goes in so many steps.
constexpr long stressed_steps = 2000;

MotionExam motion_in(std::vector<mechanics::Text> coordinates, const char* kinetic, const char* potential) {
  MotionExam exam;
  exam.text.coordinates = std::move(coordinates);
  exam.text.kinetic = {kinetic, {}};
  if (potential[0] != '\0') exam.text.potential = mechanics::Text{potential, {}};
  return exam;
}

/// A heavy block drives a light one against a wall, e = 1: with the ratio 100^k of their masses there are as
/// many impacts as the first k + 1 digits of π say (Galperin 2003). Momentum and energy at each impact, in
/// more digits, are the truth.
MotionExam blocks(double ratio) {
  MotionExam exam = motion_in({{"x", {}}, {"y", {}}}, "x'^2/2 + M*y'^2/2", "");
  exam.text.parameters = {{{"M", {}}, {std::to_string(ratio), {}}}};
  exam.text.constraints = {{{"wall", {}}, {"x >= 0", {}}}, {{"blocks", {}}, {"y >= x", {}}}};
  exam.start = {0, Vector{{1, 2}}, Vector{{0, -1}}};
  exam.restitution = 1;
  const Real M = ratio;
  Real x = 1, y = 2, v = 0, w = -1, t = 0;
  long impacts = 0;
  while (v < 0 || v > w) {
    const Real until_wall = v < 0 ? -x / v : HUGE_VALL, until_blocks = v > w ? (y - x) / (v - w) : HUGE_VALL;
    const Real dt = std::min(until_wall, until_blocks);
    x += dt * v;
    y += dt * w;
    t += dt;
    ++impacts;
    if (until_wall < until_blocks) {
      v = -v;
      x = 0;
    } else {
      const Real mean = (v + M * w) / (1 + M);
      v = 2 * mean - v;
      w = 2 * mean - w;
      y = x;
    }
  }
  exam.until = static_cast<double>(t + 1);
  exam.growth = static_cast<double>(impacts) + 10;
  exam.error = [=](const MotionOutcome& found) {
    if (found.record.impacts != impacts && found.record.impacts > 0 && found.record.steps != stressed_steps)
      return 1.0;
    const Real dv = found.end.v[0] - v, dw = found.end.v[1] - w;
    return static_cast<double>(std::sqrt(dv * dv / M + dw * dw));
  };
  return exam;
}

/// A body thrown up to a ceiling at 1 that it reaches with what is left of its speed for 1 + eps.
MotionExam grazing(double eps) {
  MotionExam exam = motion_in({{"y", {}}}, "y'^2/2", "9.81*y");
  exam.text.constraints = {{{"ceiling", {}}, {"y <= 1", {}}}};
  const double speed = std::sqrt(2 * stressed_gravity * (1 + eps));
  exam.start = {0, Vector{{0}}, Vector{{speed}}};
  exam.restitution = 1;
  const Real g = stressed_gravity, u = speed, over = u * u - 2 * g;  // what the start, a double, says
  const Real left = over > 0 ? std::sqrt(over) : 0, top = (u - left) / g;
  exam.until = static_cast<double>(top + 0.25L);
  const Real after = exam.until - top, truth = 1 - left * after - g * after * after / 2;
  // The speed left is the root of a difference.
  exam.growth = static_cast<double>(10 / std::sqrt(std::max(std::abs(over), Real{convex::unit_roundoff})));
  exam.error = [truth](const MotionOutcome& found) {
    return static_cast<double>(std::abs(found.end.q[0] - truth));
  };
  return exam;
}

/// A ball of mass 3 at rest is met from both sides, from one a little later, e = 1. One impact after the
/// other, in more digits, is the truth; both at once would leave other velocities.
MotionExam pincer(double later) {
  MotionExam exam = motion_in({{"x", {}}, {"y", {}}, {"z", {}}}, "(x'^2 + 3*y'^2 + z'^2)/2", "");
  exam.text.constraints = {{{"left", {}}, {"y >= x", {}}}, {{"right", {}}, {"z >= y", {}}}};
  exam.start = {0, Vector{{-1, 0, 1 + later}}, Vector{{1, 0, -1}}};
  exam.restitution = 1;
  exam.until = 2;
  exam.growth = 10;
  const Real mass[] = {1, 3, 1};
  Real at[] = {-1, 0, exam.start.q[2]}, speed[] = {1, 0, -1};
  for (;;) {
    Real next = HUGE_VALL;
    int which = -1;
    for (int k = 0; k < 2; ++k)
      if (speed[k] > speed[k + 1])
        if (const Real dt = (at[k + 1] - at[k]) / (speed[k] - speed[k + 1]); dt < next) {
          next = dt;
          which = k;
        }
    if (which < 0) break;
    for (int k = 0; k < 3; ++k) at[k] += next * speed[k];
    const Real mean =
        (mass[which] * speed[which] + mass[which + 1] * speed[which + 1]) / (mass[which] + mass[which + 1]);
    at[which + 1] = at[which];
    for (const int k : {which, which + 1}) speed[k] = 2 * mean - speed[k];
  }
  // Without a difference both impacts are one, and the law sends everything back.
  const bool at_once = exam.start.q[2] == 1;
  const Vector truth = at_once ? Vector{{-1, 0, 1}}
                               : Vector{{static_cast<double>(speed[0]), static_cast<double>(speed[1]),
                                         static_cast<double>(speed[2])}};
  exam.error = [truth](const MotionOutcome& found) { return (found.end.v - truth).norm(); };
  return exam;
}

/// The time at which a ball of 1 m comes to rest: (1 + 2 e/(1 - e)) √(2/g).
MotionExam long_accumulation(double less) {
  MotionExam exam = motion_in({{"y", {}}}, "y'^2/2", "9.81*y");
  exam.text.constraints = {{{"floor", {}}, {"y >= 0", {}}}};
  exam.start = {0, Vector{{1}}, Vector{{0}}};
  exam.restitution = 1 - less;
  const Real e = exam.restitution;
  const Real end = (1 + 2 * e / (1 - e)) * std::sqrt(2 / Real{stressed_gravity});
  exam.until = static_cast<double>(1.01L * end);
  exam.growth = 1 / less;
  exam.needs_events = true;
  exam.error = [end](const MotionOutcome& found) {
    return static_cast<double>(std::abs(found.accumulation - end) / end);
  };
  return exam;
}

/// x'' = -k x for a second.
MotionExam stiff_spring(double k) {
  MotionExam exam = motion_in({{"x", {}}}, "x'^2/2", "k*x^2/2");
  exam.text.parameters = {{{"k", {}}, {std::to_string(k), {}}}};
  exam.start = {0, Vector{{1}}, Vector{{0}}};
  exam.until = 1;
  exam.growth = 1 + std::sqrt(k);
  exam.error = [k](const MotionOutcome& found) {
    return static_cast<double>(std::abs(found.end.q[0] - std::cos(std::sqrt(Real{k}))));
  };
  return exam;
}

/// The energy of a ball with e = 1 after so many impacts.
MotionExam drift(double impacts) {
  MotionExam exam = motion_in({{"y", {}}}, "y'^2/2", "9.81*y");
  exam.text.constraints = {{{"floor", {}}, {"y >= 0", {}}}};
  exam.start = {0, Vector{{1}}, Vector{{0}}};
  exam.restitution = 1;
  exam.until = (2 * impacts - 0.5) * std::sqrt(2 / stressed_gravity);
  exam.error = [](const MotionOutcome& found) {
    return std::abs(found.energy - stressed_gravity) / stressed_gravity;
  };
  return exam;
}

}  // namespace

std::vector<StressFamily> motion_families() {
  const std::vector<double> small{1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16};
  std::vector<StressFamily> all;
  const auto add = [&](const char* name, const char* knob, const std::vector<double>& ladder,
                       MotionExam (*make)(double)) {
    all.push_back({name, knob, ladder, [=](double setting) {
                     MotionExam exam = make(setting);
                     exam.name = name;
                     return motion_contests(std::move(exam), stressed_steps);
                   }});
  };
  add("motion-mass-ratio", "ratio of the masses", {1, 1e2, 1e4, 1e6, 1e8}, blocks);
  add("motion-grazing", "how far beyond the ceiling", small, grazing);
  add("motion-near-simultaneous", "how much later", small, pincer);
  add("motion-accumulation", "1 - e", {0.5, 0.1, 1e-2, 1e-3, 1e-4}, long_accumulation);
  add("motion-stiff-spring", "stiffness", {1, 1e2, 1e4, 1e6, 1e8, 1e10}, stiff_spring);
  add("motion-drift", "impacts", {1e1, 1e2, 1e3, 1e4, 1e5}, drift);
  return all;
}

}  // namespace cli::inline measurement
