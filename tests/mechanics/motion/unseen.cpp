#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

/// A particle of mass 1 in a plane without weight, above f >= 0.
SystemText particle(const std::string& f, const std::string& potential = "") {
  return {{"x", "y"}, "(x'^2 + y'^2)/2", potential, {}, {}, {}, {{"c", f}}};
}

Followed pushed(const std::string& force, double until) { return tests::pushed(force, 0, 2.5, until); }

}  // namespace

TEST_CASE("a pulse far ahead, of which the series at the beginning has nothing, gives its impulse") {
  const double root = std::sqrt(std::acos(-1.0));
  for (const auto& [width, w] : {std::pair("0.05", 0.05), std::pair("0.001", 0.001)}) {
    const Followed motion = pushed("-100*exp(-((t - 2)/" + std::string(width) + ")^2)", 4);
    CHECK(std::abs(motion.end().v[0] - (2.5 - 100 * w * root)) <= 1e-11);
  }
  // A hill of 5 J turns a body of 4.5 J back.
  const Followed back =
      followed({{"x"}, "x'^2/2", "5*exp(-((x - 5)/0.25)^2)", {}, {}, {}, {}}, state({0}, {3}), 4);
  CHECK(std::abs(back.end().v[0] + 3) <= 1e-10);
}

TEST_CASE("a fast force with forty zeros at the beginning is not taken as none") {
  double binomial = 1, integral = 0;  // of sin^40 u = 2^-40 (C(40, 20) + 2 Σ (-1)^k C(40, 20 - k) cos 2ku)
  for (int k = 20; k >= 0; --k) {     // binomial: C(40, 20 - k)
    const double sign = k % 2 == 0 ? 1 : -1;
    integral += k == 0 ? 4000 * binomial : sign * binomial * std::sin(2 * k * 4000.0) / k;
    binomial *= static_cast<double>(20 + k) / (21 - k);
  }
  const Followed motion = pushed("100*sin(1000*t)^40", 4);
  CHECK(std::abs(motion.end().v[0] - (2.5 + 0.1 * integral / std::pow(2.0, 40))) <=
        1e-5);  // a beat gives 0.04
}

TEST_CASE("a bound that only min sees keeps a growing force") {
  // exp(300 (t - 2)) reaches 1000 at 2 + log(1000)/300. Coefficients of its series leave the range of doubles
  // near t = 4.1: from order 24 on.
  for (const double until : {4.0, 4.1}) {
    const Followed motion = pushed("min(1e3, exp((t - 2)*300))", until);
    const double reached = 2 + std::log(1000.0) / 300;
    CHECK(std::abs(motion.end().v[0] / (2.5 + 1000.0 / 300 + 1000 * (until - reached)) - 1) <= 1e-11);
    REQUIRE(motion.of(EventKind::branch).size() == 1);
    CHECK(std::abs(motion.of(EventKind::branch)[0].t - reached) <= 1e-12);
  }
}

TEST_CASE("narrow bumps and steep walls are met where they are") {
  const auto first_impact = [](const std::string& f) {
    const Followed motion = followed(particle(f), state({0, 0.5}, {1, 0}), 10);
    return motion.events.empty() ? 0.0 : motion.events[0].t;
  };
  for (const auto& [width, w] : {std::pair("0.01", 0.01), std::pair("0.1", 0.1), std::pair("0.5", 0.5)})
    CHECK(std::abs(first_impact("y >= exp(-((x - 5)/" + std::string(width) + ")^2)") -
                   (5 - w * std::sqrt(std::log(2.0)))) <= 1e-11);
  CHECK(std::abs(first_impact("y >= tanh((x - 5)/0.01)") - (5 + 0.01 * std::atanh(0.5))) <= 1e-11);
  CHECK(std::abs(first_impact("y >= 1/(1 + exp(-(x - 5.1)/0.01))") - 5.1) <= 1e-11);
  CHECK(std::abs(first_impact("y >= 1/cosh((x - 5)/0.01)") - (5 - 0.01 * std::acosh(2.0))) <= 1e-11);
}

TEST_CASE("a slider on a road with a bump flies off behind its top") {
  const Followed motion =
      followed(particle("y >= 0.3*exp(-((x - 5)/0.25)^2)", "9.81*y"), state({0, 0}, {3, 0}), 2.5);
  REQUIRE(!motion.events.empty());
  CHECK(motion.events[0].kind == EventKind::release);
  CHECK(motion.events[0].t > 1.5);
  // The energy of the start, but for what the landing takes.
  CHECK(motion.of(EventKind::impact).size() == 1);
  CHECK(std::abs(motion.motion.energy() - 4.5 - motion.motion.record().impact_energy) <= 1e-11);
}

TEST_CASE("beyond an edge downwards a slider flies off; at one upwards it strikes") {
  for (const char* f : {"y >= if(x > 1, 1 - x, 0)", "y >= min(0, 1 - x)"}) {
    const Followed off = followed(particle(f, "y"), state({0, 0}, {1, 0}), 1.5);
    CHECK(off.motion.status() == MotionStatus::done);
    CHECK((off.end().q - Vector{{1.5, -0.125}}).norm() <= 1e-12);
    CHECK(off.of(EventKind::release).size() == 1);
  }
  for (const double e : {0.0, 0.5, 1.0}) {
    const SystemText ramp = particle("y >= max(0, x - 1)");
    const Followed up = followed(ramp, state({0, 0}, {1, 0}), 1.5, restitution(ramp, e));
    // Of the velocity the part across the ramp turns around, e times as large.
    CHECK((up.end().v - Vector{{0.5 * (1 - e), 0.5 * (1 + e)}}).norm() <= 1e-12);
    CHECK(up.of(EventKind::impact).size() == 1);
    const SystemText corner = particle("min(x, y) >= 0");
    const Followed wall = followed(corner, state({1, 0}, {-1, 0}), 1.5, restitution(corner, e));
    CHECK((wall.end().v - Vector{{e, 0}}).norm() <= 1e-12);
    CHECK(wall.of(EventKind::impact).size() == 1);
  }
}

TEST_CASE("a motion ends where f jumps below 0, and where f jumps up a contact is left") {
  for (const char* f : {"y >= if(x > 5, 1, 0)", "y >= step(x - 5)", "y >= sign(x - 5)/1.5"}) {
    const Followed motion = followed(particle(f), state({0, 0.6}, {1, 0}), 10);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(std::abs(motion.end().t - 5) <= 1e-12);
    CHECK(motion.motion.why().find("jumps below 0") != std::string::npos);
  }
  const Followed falls = followed(particle("y >= if(x > 1, -1, 0)", "y"), state({0, 0}, {1, 0}), 2);
  CHECK((falls.end().q - Vector{{2, -0.5}}).norm() <= 1e-12);
}

TEST_CASE("a table holds to its last point, and beyond it the motion ends there, with the reason") {
  const std::string force = "table(t, [0, 1, 2, 3, 4], [0, 0, 1, 0, 0])";
  const Followed whole = pushed(force, 4);
  CHECK(whole.motion.status() == MotionStatus::done);
  CHECK(whole.end().t == 4);
  const Followed beyond = pushed(force, 5);
  CHECK(beyond.motion.status() == MotionStatus::stopped);
  CHECK(std::abs(beyond.end().t - 4) <= 1e-12);
  CHECK(beyond.motion.why().find("dry friction") == std::string::npos);
}

TEST_CASE("walls of high powers are met, and are impacts") {
  // (x - 5)^N = 1/2 on the way to 5.
  for (const int N : {12, 14, 20, 40, 60}) {
    const SystemText bump = particle("y >= 1 - (x - 5)^" + std::to_string(N));
    const double t = 5 - std::pow(0.5, 1.0 / N);
    const Followed motion = followed(bump, state({0, 0.5}, {1, 0}), t + 0.01, restitution(bump, 1));
    REQUIRE(motion.events.size() == 1);
    CHECK(motion.events[0].kind == EventKind::impact);
    CHECK(std::abs(motion.events[0].t - t) <= 1e-9);
    CHECK(std::abs(motion.motion.energy() - 0.5) <= 1e-12);
  }
  for (const auto& [f, t] : {std::pair("y >= x^40", std::pow(0.5, 1.0 / 40)),
                             std::pair("y >= (x/5)^60", 5 * std::pow(0.5, 1.0 / 60)),
                             std::pair("y >= exp(20*(x - 8))", 8 + std::log(0.5) / 20)}) {
    const Followed motion = followed(particle(f), state({0, 0.5}, {1, 0}), t + 0.1);
    REQUIRE(!motion.events.empty());
    CHECK(motion.events[0].kind == EventKind::impact);
    CHECK(std::abs(motion.events[0].t - t) <= 1e-9);
  }
}

TEST_CASE("a jump of the kinetic or the potential energy ends the motion; a kink does not") {
  for (const auto& [T, V] :
       {std::pair("x'^2/2", "if(x > 1, 1, 0)"), std::pair("if(x > 1, 2, 1)/2*x'^2", "")}) {
    const Followed motion = followed({{"x"}, T, V, {}, {}, {}, {}}, state({0}, {1}), 3);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(std::abs(motion.end().t - 1) <= 1e-12);
    CHECK(motion.motion.why().find("energy jumps") != std::string::npos);
  }
  const Followed spring =
      followed({{"x"}, "x'^2/2", "max(0, x - 1)^2/2 + max(0, x - 1)", {}, {}, {}, {}}, state({0}, {1}), 4);
  CHECK(spring.motion.status() == MotionStatus::done);
  CHECK(std::abs(spring.motion.energy() - 0.5) <= 1e-12);
  CHECK(std::abs(spring.end().v[0] + 1) <= 1e-12);
  const Followed steep =
      followed({{"x"}, "x'^2/2", "0.2*tanh((x - 1)/1e-4)", {}, {}, {}, {}}, state({0}, {1.2}), 3);
  CHECK(std::abs(steep.motion.energy() - 0.52) <= 1e-10);
}

TEST_CASE("a block comes to rest on two feet whose expressions have constants that cancel") {
  const SystemText block{{"x", "y", "a"},
                         "(x'^2 + y'^2)/2 + 0.05*a'^2",
                         "9.81*y",
                         {},
                         {},
                         {},
                         {{"l", "y - 0.5*cos(a) + 0.5*cos(a) - 0.5*sin(a) >= 0"},
                          {"r", "y + 0.5*sin(a) >= 0"},
                          {"rail", "x = 0.3*y"}}};
  MotionOptions options = restitution(block, 0.4);
  options.restitution[1] = 0.6;
  options.impact_law = ImpactLaw::poisson;
  const Followed motion = followed(block, state({0.3, 1, 0.2}, {0, 0, 1}), 3, options);
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.end().q.norm() <= 1e-12);
}

TEST_CASE("a block that rocks to rest at the origin, where no length is left to measure by, rests") {
  const SystemText block{{"x", "y", "a"},
                         "(x'^2 + y'^2 + a'^2)/2",
                         "9.81*y + 2*x",
                         {},
                         {},
                         {},
                         {{"l", "y - 0.5*sin(a) >= 0"}, {"r", "y + 0.5*sin(a) >= 0"}, {"rail", "x = 0.3*y"}}};
  const Followed motion = followed(block, state({0.3, 1, 0.3}, {0, 0, 0}), 10, restitution(block, 0.3));
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.end().q.norm() <= 1e-12);
  CHECK(motion.end().v.norm() <= 1e-12);
  CHECK((motion.motion.multipliers().head(2) - Vector{{0.5 * 10.41, 0.5 * 10.41}}).norm() <= 1e-9);
}

TEST_CASE("a branch that is not taken costs no steps where it grows without bound") {
  const SystemText text{{"y"}, "y'^2/2", "", {}, {}, {{"y", "if(t > 1, exp(-1/(t - 1)), 2)"}}, {}};
  MotionOptions options;
  options.step_limit = 2000;
  const Followed found = followed(text, state({0}, {0}), 2, options);
  // At t = 1 what follows has no series. ∫ (1 - u) e^(-1/u) over (0, 1) is A - (1/e - A)/2, A = 1/e - E₁(1).
  const double inverse = std::exp(-1), A = inverse - 0.219383934395520274;
  CHECK(found.end().t == 2);
  CHECK(found.end().q[0] == doctest::Approx(3 + A - (inverse - A) / 2).epsilon(1e-10));
}

TEST_CASE("a motion that comes to a singular position, or starts there, stops with what to do") {
  // Two wheels with a rod between them, stretched out at a = b = 0.
  const SystemText wheels{{"a", "b"},
                          "(a'^2 + b'^2)/4",
                          "",
                          {},
                          {},
                          {{"a", "1.2"}},
                          {{"coupler", "(2 + cos(b) - cos(a))^2 + (sin(b) - sin(a))^2 = 4"}}};
  SystemText pushing = wheels;
  pushing.coordinates.push_back("c");
  pushing.kinetic = "(a'^2 + b'^2 + c'^2)/4";
  pushing.constraints.push_back({"push", "c >= b"});
  // Coming from -0.3, where steps may begin so near to it that the rows there told another velocity.
  for (const auto& [speed, force] : {std::pair{3.88, -0.16}, {1.65, 2.76}}) {
    SystemText coming = wheels;
    coming.forces = {{"a", std::to_string(force)}};
    const Followed motion = followed(coming, state({-0.3, -0.3}, {speed, speed}), 1);
    CAPTURE(speed);
    const double v = motion.end().v[0];  // a = b all along
    CHECK((motion.motion.status() == MotionStatus::stopped || std::abs(v - speed - force) <= 1e-9));
    CHECK((motion.end().t == 1 || std::abs(motion.end().q[0]) <= 1e-3));
  }
  for (const bool pushes : {false, true}) {
    const Followed motion = pushes ? followed(pushing, state({0, 0, 0}, {2, 2, 2}), 1)
                                   : followed(wheels, state({0, 0}, {2, 2}), 1);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(motion.motion.why().find("a singular position") != std::string::npos);
    CHECK(motion.motion.why().find("--method time-stepping") != std::string::npos);
    CHECK(motion.motion.why().find("y^3") == std::string::npos);
  }
}

TEST_CASE(
    "what rounding leaves of a velocity at rest is no singular position, whatever the order of coordinates") {
  // A cart that is held, and what hangs from it, with a stop that just touches it: nothing moves.
  SystemText cart{{"x", "a"},
                  "7/2*x'^2 + 1/2*((x' + l*cos(a)*a')^2 + (l*sin(a)*a')^2)",
                  "-9.7*l*cos(a) + 2*x^2",
                  {{"l", "1.36"}},
                  {},
                  {{"x", "3*cos(t)"}},
                  {{"stop", "a >= 0"}, {"rail", "x = -1.763"}, {"end", "-x >= 1.763"}}};
  for (const double l : {1.36, 0.7, 2.1, 0.333})
    for (const bool swapped : {false, true}) {
      cart.parameters = {{"l", std::to_string(l)}};
      cart.coordinates = swapped ? std::vector<std::string>{"a", "x"} : std::vector<std::string>{"x", "a"};
      const State start = swapped ? state({0, -1.763}, {0, 0}) : state({-1.763, 0}, {0, 0});
      const Followed motion = followed(cart, start, 1);
      CAPTURE(l);
      CAPTURE(swapped);
      CHECK(motion.motion.status() == MotionStatus::done);
      CHECK((motion.end().q - start.q).norm() <= 1e-15);
    }
}

TEST_CASE("a narrow zone that a square tells is met at both of its sides, however far away") {
  struct Case {
    std::string zone;
    double width, until;
  };
  const Case cases[] = {{"(t - 50.3)^2 < 1e-12", 2e-6, 60},
                        {"(x - 50.3)^2 < 1e-12", 2e-6, 60},
                        {"1e-8 - (t - 5000.2)^2 > 0", 2e-4, 1e4},
                        {"x^2 - 1000.6*x + 500.3^2 < 1e-4", 2e-2, 1e3}};
  for (const auto& [zone, width, until] : cases) {
    CAPTURE(zone);
    const Followed motion =
        followed({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {{"y", "if(" + zone + ", 1, 0)"}}, {}},
                 state({0, 0}, {1, 0}), until);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().v[1] == doctest::Approx(width).epsilon(1e-7));
  }
}

TEST_CASE("a narrow bump that a quotient makes is met, however far away and however flat its tail is") {
  struct Case {
    std::string bump;
    double width, until;
  };
  const Case cases[] = {{"1/(1 + ((x - 50.3)/0.01)^8)", 0.02, 100},
                        {"1/(1 + ((t - 1.2345)/0.001)^8)", 0.002, 3},
                        {"(1 + ((t - 1.2345)/0.001)^8)^-1", 0.002, 3},
                        {"1/(1 + ((t - 1.2345)/0.1)^20)", 0.2, 3}};
  for (const auto& [bump, width, until] : cases) {
    CAPTURE(bump);
    const Followed motion =
        followed({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {{"y", "if(" + bump + " > 0.5, 1, 0)"}}, {}},
                 state({0, 0}, {1, 0}), until);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().v[1] == doctest::Approx(width).epsilon(1e-9));
  }
  const SystemText floor = particle("y >= 0.2/(1 + ((x - 50)/0.01)^8)");
  const Followed struck = followed(floor, state({0, 0.1}, {1, 0}), 60, restitution(floor, 1));
  REQUIRE(struck.motion.record().impacts == 1);
  CHECK(struck.events[0].t == doctest::Approx(49.99).epsilon(1e-9));
}

TEST_CASE("a pulse whose denominator grows beyond what doubles hold ends there, and the motion goes on") {
  // x'' = 1/cosh(kx) has the potential -2/k arctan(tanh(kx/2)), which rises by -π/k in all.
  for (const double k : {1.0, 300.0, 1e4}) {
    CAPTURE(k);
    const Followed motion =
        followed({{"x"}, "x'^2/2", "", {{"k", std::to_string(k)}}, {}, {{"x", "1/cosh(k*x)"}}, {}},
                 state({-800}, {3}), 1000);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(std::abs(motion.end().v[0] - std::sqrt(9 + 2 * std::acos(-1.0) / k)) <= 1e-12);
    CHECK(motion.motion.record().steps < 1000);
  }
}

TEST_CASE("steps as short as a fast wall asks for are taken to its end, though no force changes") {
  mechanics::MotionOptions options;
  options.step_limit = 300'000;  // 210'000 are not enough
  const Followed motion =
      followed({{"y"}, "y'^2/2", "", {}, {}, {}, {{"wall", "y >= 0.1*sin(2e6*max(0.55 - t, 0)) - 10"}}},
               state({0}, {0.01}), 100, options);
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.motion.record().steps > 220'000);
  CHECK(motion.end().q[0] == doctest::Approx(1).epsilon(1e-10));
}
