// Time for a smooth motion at an error against the truth: Taylor series, and Boost.Odeint's Dormand-Prince
// pair on the same equations written by hand, without output. Each goes through its tolerances; a row is one
// of them.
//   build/tests/benchmarks/motion_speed [REPETITIONS | --smoke]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#if __has_include(<boost/numeric/odeint.hpp>)
#include <boost/numeric/odeint.hpp>
#define MOREAU_HAS_ODEINT
#endif

#include "mechanics/motion/motion.hpp"

namespace {

using convex::Vector;
using Clock = std::chrono::steady_clock;

constexpr double until = 10;

/// A double pendulum of unit masses and lengths.
mechanics::LagrangianText double_pendulum() {
  mechanics::LagrangianText text;
  text.coordinates = {{"a", {}}, {"b", {}}};
  text.kinetic = {"a'^2 + b'^2/2 + a'*b'*cos(a - b)", {}};
  text.potential = mechanics::Text{"-9.81*(2*cos(a) + cos(b))", {}};
  return text;
}

const mechanics::State start{0, Vector{{0.6, -0.3}}, Vector{{0, 0}}};

Vector by_series(const mechanics::LagrangianSystem& system, double tolerance) {
  mechanics::MotionOptions options;
  options.tolerance = tolerance;
  mechanics::Motion motion(system, start, options);
  while (motion.advance(until)) {
  }
  Vector x(4);
  x << motion.state().q, motion.state().v;
  return x;
}

#ifdef MOREAU_HAS_ODEINT
Vector by_odeint(double tolerance) {
  namespace odeint = boost::numeric::odeint;
  using Numbers = std::array<double, 4>;
  const auto rate = [](const Numbers& x, Numbers& dx, double) {
    const double c = std::cos(x[0] - x[1]), s = std::sin(x[0] - x[1]), g = 9.81;
    const double r = -s * x[3] * x[3] - 2 * g * std::sin(x[0]), p = s * x[2] * x[2] - g * std::sin(x[1]);
    const double d = 2 - c * c;
    dx = {x[2], x[3], (r - c * p) / d, (2 * p - c * r) / d};
  };
  Numbers x{start.q[0], start.q[1], 0, 0};
  constexpr double first_step = 1e-3;
  odeint::integrate_adaptive(
      odeint::make_controlled<odeint::runge_kutta_dopri5<Numbers>>(tolerance, tolerance), rate, x, 0.0, until,
      first_step);
  return Vector{{x[0], x[1], x[2], x[3]}};
}
#endif

template <class Run>
void time(const char* name, double tolerance, const Vector& truth, int repetitions, Run run) {
  Vector x;
  const auto begin = Clock::now();
  for (int i = 0; i < repetitions; ++i) x = run();
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count() / repetitions;
  fmt::print("{:<16} {:>10.0e} {:>14.3e} {:>12.2e}\n", name, tolerance, seconds / until, (x - truth).norm());
}

}  // namespace

int main(int count, char** arguments) {
  constexpr int usual_repetitions = 100;
  const int repetitions = count > 1 ? std::max(1, std::atoi(arguments[1])) : usual_repetitions;
  const auto system = mechanics::lagrangian_system(double_pendulum());
  const Vector truth = by_series(*system, 1e-14);
  fmt::print("{:<16} {:>10} {:>14} {:>12}\n", "method", "tolerance", "s per second", "error");
  for (const double tolerance : {1e-4, 1e-7, 1e-10, 1e-12})
    time("taylor series", tolerance, truth, repetitions, [&] { return by_series(*system, tolerance); });
#ifdef MOREAU_HAS_ODEINT
  for (const double tolerance : {1e-8, 1e-10, 1e-12, 1e-14})
    time("boost.odeint", tolerance, truth, repetitions, [&] { return by_odeint(tolerance); });
#else
  fmt::print("boost.odeint: peer not found\n");
#endif
#if !__has_include(<siconos/SiconosKernel.hpp>)
  fmt::print("siconos: peer not found\n");
#else
  fmt::print("siconos: not compared here\n");
#endif
}
