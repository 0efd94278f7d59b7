// Time of the processor for a smooth motion at an error against the truth: Taylor series, and steppers of
// Boost.Odeint on the same equations written by hand, without output; those named dense give the motion
// between their steps too, as the series do and as events need it. Each goes through its tolerances; a row is
// one of them, the best of some rounds. The truth is a motion in numbers of 64 bits, by Odeint.
//   build/tests/benchmarks/motion_speed [REPETITIONS | --smoke]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <vector>

#if __has_include(<boost/numeric/odeint.hpp>)
#include <boost/numeric/odeint.hpp>
#define MOREAU_HAS_ODEINT
// Its steppers are copied before their memory is filled.
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif

#include "mechanics/motion/motion.hpp"

namespace {

using convex::Vector;

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
namespace odeint = boost::numeric::odeint;

template <class Real>
using Numbers = std::array<Real, 4>;

template <class Real>
void rate(const Numbers<Real>& x, Numbers<Real>& dx, Real) {
  const Real c = std::cos(x[0] - x[1]), s = std::sin(x[0] - x[1]), g = 9.81;
  const Real r = -s * x[3] * x[3] - 2 * g * std::sin(x[0]), p = s * x[2] * x[2] - g * std::sin(x[1]);
  const Real d = 2 - c * c;
  dx = {x[2], x[3], (r - c * p) / d, (2 * p - c * r) / d};
}

/// x at the end, by one of its steppers with control of the step.
template <class Real, class Stepper>
Vector by_odeint(Stepper stepper) {
  Numbers<Real> x{start.q[0], start.q[1], 0, 0};
  constexpr double first_step = 1e-3;
  odeint::integrate_adaptive(stepper, rate<Real>, x, Real{0}, Real{until}, Real{first_step});
  return Vector{{static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2]),
                 static_cast<double>(x[3])}};
}

/// By nobody's doubles.
Vector truth_of_motion() {
  using Stepper = odeint::runge_kutta_fehlberg78<Numbers<long double>, long double>;
  constexpr long double tolerance = 1e-18L;
  return by_odeint<long double>(odeint::make_controlled<Stepper>(tolerance, tolerance));
}
#endif

template <class Run>
void time(const char* name, double tolerance, const Vector& truth, int repetitions, Run run) {
  // Other work on the machine slows some rounds down.
  constexpr int rounds = 20;
  const int in_round = (repetitions + rounds - 1) / rounds;
  Vector x;
  double seconds = std::numeric_limits<double>::infinity();
  for (int round = 0; round * in_round < repetitions; ++round) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < in_round; ++i) x = run();
    seconds = std::min(seconds, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / in_round);
  }
  fmt::print("{:<16} {:>10.0e} {:>14.3e} {:>12.2e}\n", name, tolerance, seconds / until, (x - truth).norm());
}

}  // namespace

int main(int count, char** arguments) {
  constexpr int usual_repetitions = 400;
  const int repetitions = count > 1 ? std::max(1, std::atoi(arguments[1])) : usual_repetitions;
  const auto system = mechanics::lagrangian_system(double_pendulum());
#ifdef MOREAU_HAS_ODEINT
  const Vector truth = truth_of_motion();
#else
  const Vector truth = by_series(*system, 1e-14);
#endif
  fmt::print("{:<16} {:>10} {:>14} {:>12}\n", "method", "tolerance", "s per second", "error");
  for (const double tolerance : {1e-4, 1e-7, 1e-9, 1e-10, 1e-12})
    time("taylor series", tolerance, truth, repetitions, [&] { return by_series(*system, tolerance); });
#ifdef MOREAU_HAS_ODEINT
  for (const double tolerance : {1e-10, 1e-12, 1e-13, 1e-14}) {
    time("odeint dopri5", tolerance, truth, repetitions, [&] {
      return by_odeint<double>(
          odeint::make_controlled<odeint::runge_kutta_dopri5<Numbers<double>>>(tolerance, tolerance));
    });
    time("odeint fehlberg", tolerance, truth, repetitions, [&] {
      return by_odeint<double>(
          odeint::make_controlled<odeint::runge_kutta_fehlberg78<Numbers<double>>>(tolerance, tolerance));
    });
    time("odeint bulirsch", tolerance, truth, repetitions,
         [&] { return by_odeint<double>(odeint::bulirsch_stoer<Numbers<double>>(tolerance, tolerance)); });
    time("dopri5, dense", tolerance, truth, repetitions, [&] {
      return by_odeint<double>(
          odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<Numbers<double>>()));
    });
    time("bulirsch, dense", tolerance, truth, repetitions, [&] {
      return by_odeint<double>(odeint::bulirsch_stoer_dense_out<Numbers<double>>(tolerance, tolerance));
    });
  }
#else
  fmt::print("boost.odeint: peer not found\n");
#endif
#if !__has_include(<siconos/SiconosKernel.hpp>)
  fmt::print("siconos: peer not found\n");
#else
  fmt::print("siconos: not compared here\n");
#endif
}
