#if __has_include(<boost/numeric/odeint.hpp>)
#include <doctest/doctest.h>

#include <boost/numeric/odeint.hpp>

#include "mechanics/jet_system.hpp"
#include "tests/mechanics/motion/followed.hpp"

// A second way to a motion: Boost.Odeint's Dormand-Prince pair with dense output, on q'' = A⁻¹z of C++
// functors that Jets differentiate. Nothing of the series is in it.

using namespace mechanics;
using namespace tests;

namespace {

/// Two rods on a hinge that moves as sin t, right of a wall.
struct DrivenRods {
  static constexpr int coordinates = 2, constraints = 1;
  double m = 1.5, n = 0.75, l = 1.25, k = 0.5, g = 9.81;

  template <class S>
  S kinetic(const std::array<S, 2>& q, const std::array<S, 2>& v, const S& t) const {
    const S x = cos(t) + l * cos(q[0]) * v[0], y = l * sin(q[0]) * v[0];
    return 0.5 * m * (x * x + y * y) +
           n / 2 * (pow(x + k * cos(q[1]) * v[1], 2) + pow(y + k * sin(q[1]) * v[1], 2));
  }
  template <class S>
  S potential(const std::array<S, 2>& q, const S&) const {
    return -m * g * l * cos(q[0]) - n * g * (l * cos(q[0]) + k * cos(q[1]));
  }
  std::array<double, 2> forces(const std::array<double, 2>&, const std::array<double, 2>& v, double) const {
    return {-0.2 * v[0], 0};
  }
  template <class S>
  std::array<S, 1> f(const std::array<S, 2>& q, const S& t) const {
    return {sin(t) + l * sin(q[0]) + k * sin(q[1]) - 0.2};
  }
};

SystemText driven_rods() {
  return {{"a", "b"},
          "m/2*(x'^2 + y'^2) + n/2*((x + k*sin(b))'^2 + (y - k*cos(b))'^2)",
          "m*g*y + n*g*(y - k*cos(b))",
          {{"m", "1.5"}, {"n", "0.75"}, {"l", "1.25"}, {"k", "0.5"}, {"g", "9.81"}},
          {{"x", "sin(t) + l*sin(a)"}, {"y", "-l*cos(a)"}},
          {{"a", "-0.2*a'"}},
          {{"wall", "x + k*sin(b) >= 0.2"}}};
}

using Numbers = std::vector<double>;

State state_of(const Numbers& x, double t) {
  const auto n = static_cast<Index>(x.size() / 2);
  const Eigen::Map<const Vector> all(x.data(), 2 * n);
  return {t, all.head(n), all.tail(n)};
}

/// A⁻¹r of two coordinates, by Cramer's rule.
Vector solved(const convex::SparseMatrix& A, const Vector& r) {
  const double a = A.coeff(0, 0), b = A.coeff(0, 1), c = A.coeff(1, 1), d = a * c - b * b;
  return Eigen::Vector2d((c * r[0] - b * r[1]) / d, (a * r[1] - b * r[0]) / d);
}

/// The motion to `until` with impacts of the one constraint; counts them.
State by_second_integrator(const System& system, const State& start, double until, double e, int& impacts) {
  namespace odeint = boost::numeric::odeint;
  const auto rate = [&](const Numbers& x, Numbers& dx, double t) {
    const State at = state_of(x, t);
    const Inertia inertia = system.inertia(at);
    const Vector q2 = solved(inertia.A, inertia.z);
    const Index n = at.q.size();
    for (Index i = 0; i < n; ++i) {
      dx[static_cast<std::size_t>(i)] = at.v[i];
      dx[static_cast<std::size_t>(n + i)] = q2[i];
    }
  };
  auto stepper = odeint::make_dense_output(1e-13, 1e-13, odeint::runge_kutta_dopri5<Numbers>());
  Numbers x(start.q.begin(), start.q.end()), there(2 * x.size());
  x.insert(x.end(), start.v.begin(), start.v.end());
  constexpr double first_step = 1e-4;
  stepper.initialize(x, start.t, first_step);
  const auto gap = [&](double t) {
    stepper.calc_state(t, there);
    return system.constraint_rates(state_of(there, t)).f[0];
  };
  while (stepper.current_time() < until) {
    const auto [from, to] = stepper.do_step(rate);
    constexpr int looks = 20;
    for (int k = 1; k <= looks; ++k) {
      double low = from + (to - from) * (k - 1) / looks, high = from + (to - from) * k / looks;
      if (!(gap(high) < 0)) continue;
      if (gap(low) < 0) low = from;
      for (int i = 0; i < 100; ++i) (gap(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
      if (high > until) break;
      gap(high);
      State at = state_of(there, high);
      const Vector u = Vector(system.contact_rows(at, {0}).U.row(0).transpose());
      const Vector w = solved(system.inertia(at).A, u);
      at.v -= (1 + e) * system.constraint_rates(at).df[0] / u.dot(w) * w;
      ++impacts;
      Numbers after(at.q.begin(), at.q.end());
      after.insert(after.end(), at.v.begin(), at.v.end());
      stepper.initialize(after, high, first_step);
      break;
    }
  }
  stepper.calc_state(until, there);
  return state_of(there, until);
}

}  // namespace

TEST_CASE("Taylor series and Boost.Odeint lead to the same state, through impacts") {
  const JetSystem<DrivenRods> functors({}, {"a", "b"}, {{"wall", false, {}}});
  const State start = state({0.9, 0.4}, {0.5, -1});
  int impacts = 0;
  const State second = by_second_integrator(functors, start, 1.5, 0.7, impacts);
  const Followed first = followed(driven_rods(), start, 1.5, restitution(driven_rods(), 0.7));
  CHECK(impacts >= 1);
  CHECK(first.of(EventKind::impact).size() == static_cast<std::size_t>(impacts));
  CHECK((first.end().q - second.q).norm() <= 1e-9);
  CHECK((first.end().v - second.v).norm() <= 1e-8);
}
#endif
