#include <doctest/doctest.h>

#include "mechanics/gauss_problem.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/jet_system.hpp"

using namespace mechanics;

/// A bar of mass m and moment of inertia J on two trestles at x = -h and x = h: y is the height of its
/// middle, a its angle.
struct Bar {
  static constexpr int coordinates = 2, constraints = 2;
  double m = 2, J = 0.5, h = 1, g = 9.81;

  template <class S>
  S kinetic(const std::array<S, 2>&, const std::array<S, 2>& v, const S&) const {
    return m / 2 * v[0] * v[0] + J / 2 * v[1] * v[1];
  }
  template <class S>
  S potential(const std::array<S, 2>& q, const S&) const {
    return m * g * q[0];
  }
  /// A weight of 60 N hangs 1.5 from the middle, beyond the right trestle.
  std::array<double, 2> forces(const std::array<double, 2>&, const std::array<double, 2>&, double) const {
    return {-60, -90};
  }
  template <class S>
  std::array<S, 2> f(const std::array<S, 2>& q, const S&) const {
    return {q[0] - h * sin(q[1]), q[0] + h * sin(q[1])};
  }
};

TEST_CASE("a mechanism in C++: which contacts persist, and with which reactions") {
  const JetSystem<Bar> system({}, {"y", "a"}, {{"left", false, {}}, {"right", false, {}}});
  const State at_rest{0, Vector::Zero(2), Vector::Zero(2)};
  const GaussProblem gauss = gauss_problem(system, at_rest, Vector::Constant(2, default_contact_tolerance));
  CHECK(gauss.contacts.present.size() == 2);

  const GaussSolution solution = solve(gauss.problem);
  CHECK(solution.primal.status == convex::Status::solved);
  // Right persists and left opens: y'' = -a'' with m y'' = -m g - 60 + R and J a'' = -90 + R.
  const double reaction = (90 / 0.5 + 9.81 + 60 / 2.0) / (1 / 2.0 + 1 / 0.5);
  CHECK(solution.primal.lambda[0] == 0);
  CHECK(solution.primal.slack[0] > 0);
  CHECK(solution.primal.lambda[1] == doctest::Approx(reaction).epsilon(1e-14));
  CHECK_FALSE(solution.hypothesis.accepted);  // that both persist
}
