// Time of the processor for a simulated second of motions with impacts at the error of their impact times:
// our events, and the event-driven scheme of Siconos (LsodarOSI) on the same scenes written by hand, both
// without output. Each goes through its tolerances; a row is one of them.
//   build/tests/benchmarks/impact_speed [REPETITIONS | --smoke]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "mechanics/motion/motion.hpp"
#include "tests/benchmarks/impact_speed/siconos_events.hpp"
#include "tests/benchmarks/impact_speed/slider_crank.hpp"

namespace {

using convex::Index;
using convex::Vector;
using peers::Times;

// ---- Scenes: a point of mass 1 between walls, x >= low and x <= high, with restitution e

/// Falls from height 1.
constexpr double gravity = 9.81, bounce = 0.9, ball_end = 4;
/// Walls at A sin(omega t) ± d.
constexpr double amplitude = 1, play = 1, omega = 2 * std::numbers::pi, loss = 0.7, pair_begin = 0.5,
                 pair_end = 2;
constexpr double pair_x = 0.2813379344596052, pair_v = -7.900287907308598;

Times ball_truth() {
  Times times;
  long double t = std::sqrt(2.0L / gravity), v = gravity * t;
  while (t < ball_end) {
    times.push_back(static_cast<double>(t));
    v *= bounce;
    t += 2 * v / gravity;
  }
  return times;
}

/// Flights are straight lines between A sin(omega t) + d and A sin(omega t) - d, by turns.
Times pair_truth() {
  Times times;
  long double t = pair_begin, x = pair_x, v = pair_v;
  const long double w = omega;
  const auto wall = [&](long double at, int side) { return amplitude * std::sin(w * at) + side * play; };
  for (int side = -1;; side = -side) {
    // The first time that the point is beyond the wall, by small steps, then by bisection.
    long double low = t, high = t;
    constexpr long double little = 1e-4L;
    const auto beyond = [&](long double at) { return side * (x + v * (at - t) - wall(at, side)) > 0; };
    do {
      low = high;
      high += little;
    } while (!beyond(high) || high - t < 10 * little);
    for (int k = 0; k < 70; ++k) {
      const long double middle = 0.5L * (low + high);
      (beyond(middle) ? high : low) = middle;
    }
    if (low > pair_end) return times;
    times.push_back(static_cast<double>(low));
    const long double u = amplitude * w * std::cos(w * low);
    x = wall(low, side);
    v = u - loss * (v - u);
    t = low;
  }
}

double worst(const Times& found, const Times& truth) {
  if (found.size() < truth.size()) return std::numeric_limits<double>::infinity();
  double error = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) error = std::max(error, std::abs(found[k] - truth[k]));
  return error;
}

Times impacts(const mechanics::LagrangianSystem& system, const mechanics::State& start, double e,
              double until, double tolerance) {
  mechanics::MotionOptions options;
  options.tolerance = tolerance;
  options.restitution = Vector::Constant(static_cast<Index>(system.constraints().size()), e);
  mechanics::Motion motion(system, start, options);
  Times times;
  bool goes_on = true;
  while (goes_on) {
    goes_on = motion.advance(until);
    for (const mechanics::MotionEvent& event : motion.events())
      if (event.kind == mechanics::EventKind::impact && (times.empty() || event.t > times.back()))
        times.push_back(event.t);
  }
  return times;
}

mechanics::LagrangianText ball() {
  mechanics::LagrangianText text;
  text.coordinates = {{"x", {}}};
  text.kinetic = {"x'^2/2", {}};
  text.potential = mechanics::Text{"9.81*x", {}};
  text.constraints = {{{"floor", {}}, {"x >= 0", {}}}};
  return text;
}

mechanics::LagrangianText pair() {
  mechanics::LagrangianText text;
  text.coordinates = {{"x", {}}};
  text.kinetic = {"x'^2/2", {}};
  text.constraints = {{{"left", {}}, {"x >= sin(2*pi*t) - 1", {}}},
                      {{"right", {}}, {"x <= sin(2*pi*t) + 1", {}}}};
  return text;
}

mechanics::LagrangianText slider_crank() {
  using namespace peers::slider_crank;
  mechanics::LagrangianText text;
  text.coordinates = {{"p1", {}}, {"p2", {}}, {"p3", {}}};
  for (const auto& [name, value] : std::initializer_list<std::pair<const char*, double>>{{"l1", l1},
                                                                                         {"l2", l2},
                                                                                         {"a", a},
                                                                                         {"b", b},
                                                                                         {"c", c},
                                                                                         {"m1", m1},
                                                                                         {"m2", m2},
                                                                                         {"m3", m3},
                                                                                         {"J1", J1},
                                                                                         {"J2", J2},
                                                                                         {"J3", J3},
                                                                                         {"g", gravity}})
    text.parameters.push_back({{name, {}}, {fmt::format("{}", value), {}}});
  for (const auto& [name, value] :
       std::initializer_list<std::pair<const char*, const char*>>{{"X1", "l1/2*cos(p1)"},
                                                                  {"Y1", "l1/2*sin(p1)"},
                                                                  {"X2", "l1*cos(p1) + l2/2*cos(p2)"},
                                                                  {"Y2", "l1*sin(p1) + l2/2*sin(p2)"},
                                                                  {"X3", "l1*cos(p1) + l2*cos(p2)"},
                                                                  {"Y3", "l1*sin(p1) + l2*sin(p2)"}})
    text.definitions.push_back({{name, {}}, {value, {}}});
  text.kinetic = {
      "m1/2*(X1'^2 + Y1'^2) + m2/2*(X2'^2 + Y2'^2) + m3/2*(X3'^2 + Y3'^2) + J1/2*p1'^2 + J2/2*p2'^2 + "
      "J3/2*p3'^2",
      {}};
  text.potential = mechanics::Text{"g*(m1*Y1 + m2*Y2 + m3*Y3)", {}};
  text.constraints = {{{"corner1", {}}, {"Y3 - a*sin(p3) + b*cos(p3) <= b + c", {}}},
                      {{"corner2", {}}, {"Y3 + a*sin(p3) + b*cos(p3) <= b + c", {}}},
                      {{"corner3", {}}, {"Y3 - a*sin(p3) - b*cos(p3) >= -b - c", {}}},
                      {{"corner4", {}}, {"Y3 + a*sin(p3) - b*cos(p3) >= -b - c", {}}}};
  return text;
}

/// By our own events at their best: both of our integrators agree with these to the last digits (`moreau
/// simulate docs/problems/motion_slider_crank.toml`).
const Times crank_truth{0.0026925027520212134, 0.005607797868070757, 0.007465635169560194,
                        0.008409252749069568, 0.00883164216054835};

void time(const char* scene, const char* name, double setting, double span, const Times& truth,
          int repetitions, const std::function<Times()>& run) {
  // The best of some rounds: other work on the machine slows some of them down.
  constexpr int rounds = 20;
  const int in_round = (repetitions + rounds - 1) / rounds;
  Times found;
  double seconds = std::numeric_limits<double>::infinity();
  for (int round = 0; round * in_round < repetitions; ++round) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < in_round; ++i) found = run();
    seconds = std::min(seconds, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / in_round);
  }
  fmt::print("{:<14} {:<16} {:>10.0e} {:>14.3e} {:>10.1e} {:>8} of {}\n", scene, name, setting,
             seconds / span, worst(found, truth), found.size(), truth.size());
}

}  // namespace

int main(int count, char** arguments) {
  constexpr int usual_repetitions = 2000;
  const int repetitions = count > 1 ? std::max(1, std::atoi(arguments[1])) : usual_repetitions;
  const Times of_ball = ball_truth(), of_pair = pair_truth();
  const auto ball_system = mechanics::lagrangian_system(ball()),
             pair_system = mechanics::lagrangian_system(pair());
  const mechanics::State ball_start{0, Vector{{1}}, Vector{{0}}},
      pair_start{pair_begin, Vector{{pair_x}}, Vector{{pair_v}}};
  fmt::print("{:<14} {:<16} {:>10} {:>14} {:>10} {:>8}\n", "scene", "method", "tolerance", "s per second",
             "error", "impacts");
  for (const double tolerance : {1e-6, 1e-10, 1e-14})
    time("ball", "events", tolerance, ball_end, of_ball, repetitions,
         [&] { return impacts(*ball_system, ball_start, bounce, ball_end, tolerance); });
  for (const double tolerance : {1e-6, 1e-10, 1e-14})
    time("impact pair", "events", tolerance, pair_end - pair_begin, of_pair, repetitions,
         [&] { return impacts(*pair_system, pair_start, loss, pair_end, tolerance); });
  const auto crank_system = mechanics::lagrangian_system(slider_crank());
  const mechanics::State in_line{0, Vector::Zero(3),
                                 Vector{{peers::slider_crank::w0, -peers::slider_crank::w0 / 2, 0}}};
  const double crank_end = peers::slider_crank::end, crank_loss = peers::slider_crank::restitution;
  for (const double tolerance : {1e-6, 1e-10, 1e-14})
    time("slider-crank", "events", tolerance, crank_end, crank_truth, repetitions,
         [&] { return impacts(*crank_system, in_line, crank_loss, crank_end, tolerance); });
#ifdef MOREAU_HAS_SICONOS
  // Theirs is seen from the walls: y = x - A sin(omega t), y'' = A omega² sin(omega t).
  const peers::SiconosScene theirs{0, ball_end, 1, 0, bounce, -gravity, 0, {{1, 0}}},
      shaken{pair_begin,
             pair_end,
             pair_x - amplitude * std::sin(omega * pair_begin),
             pair_v - amplitude * omega * std::cos(omega * pair_begin),
             loss,
             0,
             omega,
             {{1, play}, {-1, play}}};
  const int fewer = std::max(1, repetitions / 20);
  for (const double step : {0.5, 0.05})
    for (const double tolerance : {1e-6, 1e-10, 1e-14})
      time("ball", step > 0.1 ? "siconos h 0.5" : "siconos h 0.05", tolerance, ball_end, of_ball, fewer,
           [&] { return peers::by_siconos(theirs, tolerance, step); });
  for (const double tolerance : {1e-6, 1e-10, 1e-14})
    time("impact pair", "siconos h 0.05", tolerance, pair_end - pair_begin, of_pair, fewer,
         [&] { return peers::by_siconos(shaken, tolerance, 0.05); });
  for (const double step : {0.5, 1e-3})
    for (const double tolerance : {1e-6, 1e-10, 1e-14})
      time("slider-crank", step > 0.1 ? "siconos h 0.5" : "siconos h 0.001", tolerance, crank_end,
           crank_truth, fewer, [&] { return peers::slider_crank_by_siconos(tolerance, step); });
#else
  fmt::print("siconos: peer not found\n");
#endif
}
