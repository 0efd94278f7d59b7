#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "mechanics/singular/resolution.hpp"
#include "tests/mechanics/singular_answer.hpp"

using namespace mechanics;
using tests::Answer;
using tests::answer;
using tests::error_of;
using tests::Lines;
using tests::particle;

namespace {

/// A particle in space under gravity, its coordinates of unequal inertia.
std::unique_ptr<const LagrangianSystem> in_space(const Lines& constraints) {
  return tests::system(
      {{"x", "y", "z"}, "x'^2/2 + y'^2 + 2*z'^2 + x'*y'/3", "9.81*z + x", {}, {}, {}, constraints});
}

/// A state that moves along the curve of a system's first two constraints.
State along_curve(const LagrangianSystem& system, std::vector<double> place) {
  State state = tests::state(std::move(place), {0, 0, 0});
  const convex::Matrix U(system.contact_rows(state, {0, 1}).U);
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3, k = (i + 2) % 3;
    state.v[i] = U(0, j) * U(1, k) - U(0, k) * U(1, j);
  }
  return state;
}

/// Cranks of radius 1 side by side on a coupler of length 2.
std::unique_ptr<const LagrangianSystem> cranks(double torque, const Lines& more = {}) {
  Lines constraints{{"along", "cos(a) + 2*cos(k) = 2 + cos(b)"}, {"across", "sin(a) + 2*sin(k) = sin(b)"}};
  constraints.insert(constraints.end(), more.begin(), more.end());
  return tests::system({{"a", "b", "k"},
                        "(a'^2 + b'^2)/4 + k'^2/6",
                        "",
                        {},
                        {},
                        {{"a", std::to_string(torque)}},
                        constraints});
}

/// A third crank in the middle of the coupler.
std::unique_ptr<const LagrangianSystem> three_cranks() {
  return tests::system({{"a", "b", "c", "k"},
                        "(a'^2 + b'^2 + c'^2)/4 + k'^2/6",
                        "",
                        {},
                        {},
                        {{"a", "3"}},
                        {{"along", "cos(a) + 2*cos(k) = 2 + cos(b)"},
                         {"across", "sin(a) + 2*sin(k) = sin(b)"},
                         {"middle_along", "cos(a) + cos(k) = 1 + cos(c)"},
                         {"middle_across", "sin(a) + sin(k) = sin(c)"}}});
}

bool is_near_state(const Vector& x, const Vector& y, double tolerance = 1e-12) {
  return (x - y).norm() <= tolerance * std::max(1.0, y.norm());
}

}  // namespace

TEST_CASE("a bead that passes a crossing of two wires moves as on the wire it is on alone") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coefficient(-2, 2);
  for (int trial = 0; trial < 30; ++trial) {
    const auto wire = [&] {
      return std::to_string(coefficient(random)) + "*x + " + std::to_string(coefficient(random)) + "*y + " +
             std::to_string(coefficient(random)) + "*x^2 + " + std::to_string(coefficient(random)) +
             "*x*y + " + std::to_string(coefficient(random)) + "*sin(y)^2 + x^3";
    };
    const std::string one = wire(), other = wire();
    CAPTURE(one);
    CAPTURE(other);
    const auto alone = particle({{"wire", one + " = 0"}});
    const auto crossing = particle({{"wires", "(" + one + ")*(" + other + ") = 0"}});
    State state = tests::state({0, 0}, {0, 0});
    const ContactRows rows = alone->contact_rows(state, {0});
    state.v << rows.U.coeff(0, 1), -rows.U.coeff(0, 0);
    const Answer found = answer(*crossing, state), expected = answer(*alone, state);
    REQUIRE(found.resolution.added.size() == 1);
    CHECK(expected.resolution.added.empty());
    CHECK(is_near_state(found.q2(), expected.q2(), 1e-11));
    CHECK(found.solution.primal.status == convex::Status::solved);
    CHECK(is_near_state(found.solution.reaction, expected.solution.reaction, 1e-11));
    REQUIRE(found.resolution.warnings.size() == 1);
    CHECK(found.resolution.warnings[0].kind == Warning::Kind::singular);
  }
}

TEST_CASE("surfaces that touch each other let pass what their crossing curve lets pass") {
  // On {g = 0} the second constraint is a*b: its gradient there vanishes where the wire a = 0 crosses b = 0.
  std::mt19937 random(13);
  std::uniform_real_distribution<double> coefficient(-2, 2);
  const auto number = [&] { return std::to_string(coefficient(random)); };
  std::size_t touching = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const std::string place[] = {number(), number(), number()};
    const auto surface = [&] {
      const std::string x = "(x - " + place[0] + ")", y = "(y - " + place[1] + ")",
                        z = "(z - " + place[2] + ")";
      return "(" + number() + "*" + x + " + " + number() + "*" + y + " + " + number() + "*" + z + " + " +
             number() + "*" + x + "*" + y + " + " + number() + "*sin(" + z + ")^2 + " + number() + "*" + y +
             "^2*" + x + ")";
    };
    const std::string g = surface(), a = surface(), b = surface();
    CAPTURE(g);
    CAPTURE(a);
    CAPTURE(b);
    const auto curve = in_space({{"g", g + " = 0"}, {"a", a + " = 0"}});
    const auto touch = in_space({{"g", g + " = 0"}, {"touch", "2.5*" + g + " + " + a + "*" + b + " = 0"}});
    const State state = along_curve(*curve, {std::stod(place[0]), std::stod(place[1]), std::stod(place[2])});
    const Answer found = answer(*touch, state), expected = answer(*curve, state);
    CHECK(is_near_state(found.q2(), expected.q2(), 1e-9));
    CHECK(is_near_state(found.solution.reaction, expected.solution.reaction, 1e-9));
    touching += found.resolution.added.size();
  }
  CHECK(touching == 60);
}

TEST_CASE("a constraint that others imply changes nothing, at rest and in motion") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> coefficient(-2, 2);
  const auto number = [&] { return std::to_string(coefficient(random)); };
  for (int trial = 0; trial < 40; ++trial) {
    const auto surface = [&] {
      return "(" + number() + "*x + " + number() + "*y + " + number() + "*z + " + number() + "*x*y + " +
             number() + "*sin(z)^2)";
    };
    const std::string g = surface(), h = surface();
    CAPTURE(g);
    CAPTURE(h);
    const Lines both{{"g", g + " = 0"}, {"h", h + " = 0"}};
    Lines more = both;
    more.emplace_back("implied", "(" + number() + " + x)*" + g + " + " + number() + "*" + h + " + " + g +
                                     "*" + h + " + " + g + "^2 = 0");
    const auto fewer = in_space(both), all = in_space(more);
    State state = along_curve(*fewer, {0, 0, 0});
    if (trial % 2 == 0) state.v.setZero();
    const Answer found = answer(*all, state), expected = answer(*fewer, state);
    CHECK(found.resolution.added.empty());
    CHECK(is_near_state(found.q2(), expected.q2(), 1e-10));
  }
}

TEST_CASE(
    "a flat parallelogram in motion turns on as one body: both cranks share the torque, the coupler does not "
    "turn") {
  const State state = tests::state({0, 0, 0}, {5, 5, 0});
  const Answer found = answer(*cranks(3), state);
  REQUIRE(found.resolution.added.size() == 1);
  CHECK(is_near_state(found.q2(), Vector{{3, 3, 0}}));
  const AddedRow& row = found.resolution.added[0];
  // d³(along)/dt³ = -3 (a' a'' - b' b'') at k = k' = 0.
  CHECK(row.weights == std::vector<std::pair<Index, double>>{{0, 1.0}});
  CHECK(row.row == Vector{{-15, 15, 0}});
  CHECK(row.rhs == 0);
  CHECK(found.solution.residuals.stationarity <= 1e-14);
}

TEST_CASE("the other mode of a flat four-bar is found from its velocities") {
  // a' = -b': then 2 k' = b' - a'. On 2 (1 - cos k) = cos a - cos b, 2 sin k = sin b - sin a the branch
  // leaves with both signs; with equal cranks a'^2 + 2 k'^2 = b'^2 fails unless k' = 0.
  const Answer found = answer(*cranks(3), tests::state({0, 0, 0}, {5, -5, -5}));
  CHECK(found.solution.primal.status == convex::Status::infeasible);
}

TEST_CASE("loops that are redundant everywhere pass: nothing is added, nothing is said") {
  const double l = std::sqrt(2.0), v = 1.5;
  const auto rod = tests::system({{"x", "y"},
                                  "(x'^2 + y'^2)/2",
                                  "9.81*y",
                                  {{"l", "sqrt(2)"}},
                                  {},
                                  {},
                                  {{"rod", "sqrt(x^2 + y^2) = l"}, {"twin", "x^2 + y^2 = l^2"}}});
  const Answer once =
      answer(*rod, tests::state({l * std::sin(1), -l * std::cos(1)}, {v * std::cos(1), v * std::sin(1)}));
  CHECK(once.resolution.added.empty());
  CHECK(once.resolution.warnings.empty());

  // A third crank in the middle, at any angle but the flat one.
  const auto three = three_cranks();
  for (const double angle : {0.3, 1.0, 2.5}) {
    const Answer found = answer(*three, tests::state({angle, angle, angle, 0}, {5, 5, 5, 0}));
    CHECK(found.resolution.added.empty());
    CHECK(found.resolution.warnings.empty());
    CHECK(is_near_state(found.q2(), Vector{{2, 2, 2, 0}}));
  }

  for (const char* always : {"sin(x)^2 + cos(x)^2 = 1", "x - x = 0", "x*y = 0", "exp(x) = 1"}) {
    CAPTURE(always);
    const Answer found =
        answer(*particle({{"slot", "x = 0"}, {"always", always}}), tests::state({0, 0.7}, {0, 2}));
    CHECK(found.resolution.added.empty());
    CHECK(found.resolution.warnings.empty());
    CHECK(is_near_state(found.q2(), Vector{{0, -9.81}}));
  }
}

TEST_CASE("a third crank on a flat parallelogram takes its part of the torque as well") {
  const auto three = three_cranks();
  const Answer found = answer(*three, tests::state({0, 0, 0, 0}, {5, 5, 5, 0}));
  CHECK(is_near_state(found.q2(), Vector{{2, 2, 2, 0}}));
  CHECK_FALSE(found.resolution.added.empty());
}

TEST_CASE("a state whose branches only fourth derivatives tell apart is refused, and why") {
  const auto said = [](const Lines& constraints, const State& state) {
    const auto system = particle(constraints);
    return error_of([&] { answer(*system, state); });
  };
  const State rest = tests::state({0, 0}, {0, 0});
  CHECK(said({{"wires", "y^2 = x^2"}}, rest).find("40:1 constraint wires: its gradient vanishes") == 0);
  CHECK(said({{"wires", "y^2 = x^2"}}, rest).find("several branches; give a velocity or move off it") !=
        std::string::npos);
  CHECK(said({{"square", "y^2 = x^4"}}, rest).find("write it so that its gradient does not vanish") !=
        std::string::npos);
  CHECK(said({{"flat", "y^4 + y^5 = 0"}}, rest).find("up to the fourth do not tell") != std::string::npos);
  CHECK(said({{"slot", "x = 0"}, {"late", "x = t^3"}}, rest).find("third derivatives contradict") !=
        std::string::npos);
}

TEST_CASE(
    "at a cusp that points against the force rest is refused, at one that points along it the fall stands") {
  const State rest = tests::state({0, 0}, {0, 0});
  // x = ±y^(3/2) and the like leave y >= 0 alone, where gravity does not lead.
  for (const char* upwards : {"x^2 = y^3", "x^2 = y^5", "(x - y^2)^2 = y^5", "x^2 + x*y^2 = y^3 - 2*y^4"}) {
    CAPTURE(std::string(upwards));
    const auto system = particle({{"cusp", upwards}});
    const std::string said = error_of([&] { answer(*system, rest); });
    CHECK(said.find("40:1 constraint cusp: its gradient vanishes") == 0);
    CHECK(said.find("exclude it: the state is a cusp") != std::string::npos);
  }
  // These have motions with y = -9.81 t²/2: x = ±(-y)^(3/2), and the parabolas y = ±x² for y'' = 0.
  for (const char* downwards : {"x^2 + y^3 = 0", "x^2 + y^5 = 0", "x^2 = y^4"}) {
    CAPTURE(std::string(downwards));
    const Answer found = answer(*particle({{"cusp", downwards}}), rest);
    CHECK(is_near_state(found.q2(), Vector{{0, -9.81}}));
    CHECK(found.resolution.warnings.empty());
  }
  // Beside another constraint that holds: on the sphere, near (0, 0, 0), the same cusp.
  const auto on_sphere = [](const std::string& cusp) {
    return tests::system({{"x", "y", "z"},
                          "(x'^2 + y'^2 + z'^2)/2",
                          "9.81*y",
                          {},
                          {},
                          {},
                          {{"sphere", "x^2 + y^2 + (z - 1)^2 = 1"}, {"cusp", cusp}}});
  };
  const State bottom = tests::state({0, 0, 0}, {0, 0, 0});
  CHECK(error_of([&] { answer(*on_sphere("x^2 = y^3"), bottom); }).find("is a cusp") != std::string::npos);
  CHECK(is_near_state(answer(*on_sphere("x^2 + y^3 = 0"), bottom).q2(), Vector{{0, -9.81, 0}}));
}

TEST_CASE("a cusp too sharp for the derivatives that are followed is warned of") {
  const Answer found = answer(*particle({{"cusp", "x^2 = y^7"}}), tests::state({0, 0}, {0, 0}));
  REQUIRE(found.resolution.warnings.size() == 1);
  CHECK(found.resolution.warnings[0].message.find("too high an order") != std::string::npos);
}

TEST_CASE("a machine that rests in equilibrium at a singular position stays there") {
  const Answer crossing = answer(*particle({{"wires", "y^2 = x^2"}}, {}, "0"), tests::state({0, 0}, {0, 0}));
  CHECK(crossing.q2() == Vector{{0, 0}});
  const Answer flat = answer(*cranks(0), tests::state({0, 0, 0}, {0, 0, 0}));
  CHECK(flat.q2() == Vector{{0, 0, 0}});
}

TEST_CASE("a driven flat parallelogram at rest has several motions and is refused") {
  const auto system = cranks(3);
  CHECK(error_of([&] {
          answer(*system, tests::state({0, 0, 0}, {0, 0, 0}));
        }).find("several branches") != std::string::npos);
}

TEST_CASE("gradients that vanish but for the rounding of pi are seen to vanish") {
  const double pi = 3.14159265358979323846;
  const Answer turned = answer(*cranks(3), tests::state({pi, pi, 0}, {5, 5, 0}));
  REQUIRE(turned.resolution.added.size() == 1);
  CHECK(is_near_state(turned.q2(), Vector{{3, 3, 0}}));
}

TEST_CASE("one-sided contacts are solved together with the equations that third derivatives add") {
  // On the wire y = x, held up by a stop: x'' >= 0 beside x'' = y''.
  const Answer stopped =
      answer(*particle({{"wires", "y^2 = x^2"}, {"stop", "x >= t"}}), tests::state({0, 0}, {1, 1}));
  REQUIRE(stopped.resolution.added.size() == 1);
  CHECK(is_near_state(stopped.q2(), Vector{{0, 0}}));
  CHECK(stopped.solution.multipliers.least_norm[1] == doctest::Approx(9.81));
}

TEST_CASE("where a third derivative does not exist nothing is added, and a warning says so") {
  const Answer found = answer(*particle({{"kink", "y^2 = x^2.5*y"}}, {}, "0"), tests::state({0, 0}, {1, 0}));
  CHECK(found.resolution.added.empty());
  REQUIRE(found.resolution.warnings.size() == 1);
  CHECK(found.resolution.warnings[0].message.find("is not finite") != std::string::npos);
}

TEST_CASE("a chain of regular joints costs no second solve") {
  int solves = 0;
  const auto chain = tests::system(
      {{"x[1..40]", "y[1..40]"},
       "sum(i in 1..40, x[i]'^2 + y[i]'^2)",
       "sum(i in 1..40, 9.81*y[i])",
       {},
       {},
       {},
       {{"first", "x[1]^2 + y[1]^2 = 1"}, {"rod[i in 1..39]", "(x[i+1] - x[i])^2 + (y[i+1] - y[i])^2 = 1"}}});
  State state{0, Vector::Zero(80), Vector::Zero(80)};
  for (Index i = 0; i < 40; ++i) state.q[40 + i] = -static_cast<double>(i + 1);
  const Vector tolerance = Vector::Constant(40, default_contact_tolerance);
  GaussSolution kept;
  const Resolution found =
      resolve(*chain, state, guessed_radii(state), gauss_problem(*chain, state, tolerance),
              [&](const convex::NearestPointProblem& problem) -> const GaussSolution& {
                ++solves;
                return kept = solve(problem);
              });
  CHECK(solves == 1);
  CHECK(found.warnings.empty());
}

TEST_CASE("a redundant loop typed with ten digits counts as redundant, and is said to") {
  const auto three = three_cranks();
  const Answer found =
      answer(*three, tests::state({1.0471975512, 1.0471975509, 1.0471975516, 0}, {5, 5, 5.0000000002, 0}));
  CHECK(is_near_state(found.q2(), Vector{{2, 2, 2, 0}}, 1e-6));
  REQUIRE(found.resolution.warnings.size() == 1);
  CHECK(found.resolution.warnings[0].kind == Warning::Kind::singular);
  CHECK(found.resolution.warnings[0].message.find("more digits") != std::string::npos);
  CHECK(found.solution.multipliers.unique == false);
}
