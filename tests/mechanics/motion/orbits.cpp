#include "mechanics/motion/orbit_section.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

/// A mass between walls A sin(w t) ± d.
SystemText pair(const char* A, const char* d, const char* w) {
  return {{"x"},
          "x'^2/2",
          "",
          {{"A", A}, {"d", d}, {"w", w}},
          {},
          {},
          {{"lower", "x - A*sin(w*t) >= -d"}, {"upper", "x - A*sin(w*t) <= d"}}};
}

}  // namespace

TEST_CASE(
    "the symmetric orbit of the impact pair has the phase, the speed and the multipliers of its closed "
    "form") {
  const SystemText text = pair("1", "1", "2*pi");
  const auto made = system(text);
  OrbitQuestion question;
  question.motion = restitution(text, 0.7);
  question.period = 1;
  const Orbit found = find_orbit(*made, state({0.28334}, {-7.9043}, 0.5), question);
  REQUIRE(found.is_found);
  REQUIRE(found.impacts.size() == 2);
  const double phase = 1.794547460536939, pi = std::acos(-1.0);
  CHECK(std::abs(found.impacts[1].t - (1 + phase / (2 * pi))) <= 1e-12);
  CHECK(std::abs(found.impacts[0].velocity_after[0] - 7.9002879073085985) <= 1e-11);
  REQUIRE(found.multipliers);
  CHECK(std::abs((*found.multipliers)[0] - 3.44640644840723306477424) <= 1e-13);
  CHECK(std::abs((*found.multipliers)[1] - 0.069666768442521608343461) <= 1e-13);
  // The product is e^4: two impacts, each with e^2.
  CHECK(std::abs((*found.multipliers)[0] * (*found.multipliers)[1] - std::pow(0.7, 4)) <= 1e-13);
  CHECK_FALSE(found.is_stable);
}

TEST_CASE("a state that comes back after what is no period of the forcing is no orbit") {
  // The map over any time has a fixed point here.
  const SystemText text{{"x"}, "x'^2/2", "2*x^2", {}, {}, {{"x", "cos(1.5*t) - 0.3*x'"}}, {}};
  const auto made = system(text);
  const double period = 2 * std::acos(-1.0) / 1.5;
  OrbitQuestion question;
  for (const double other : {1.0, 1.5 * period, period * (1 + 1e-4)}) {
    question.period = other;
    const Orbit found = find_orbit(*made, state({0}, {0}), question);
    CHECK_FALSE(found.is_found);
    CHECK(found.why.find("neither a period") != std::string::npos);
  }
  for (const double k : {1, 2, 7}) {
    question.period = k * period;
    CHECK(find_orbit(*made, state({0}, {0}), question).is_found);
  }
}

TEST_CASE("a period is one for contacts held on what moves, for what turns, and for forces that jump") {
  const double period = 2 * std::acos(-1.0) / 3;
  OrbitQuestion question;
  question.period = period;
  const auto is_found = [&](const SystemText& text, const mechanics::State& guess) {
    const Orbit found = find_orbit(*system(text), guess, question);
    CAPTURE(found.why);
    CHECK(found.is_found);
  };
  is_found({{"y"}, "y'^2/2", "9.81*y", {}, {}, {}, {{"table", "y >= 0.1*sin(3*t)"}}}, state({0}, {0.3}));
  is_found({{"x", "y"}, "(x'^2+y'^2)/2", "2*x^2", {}, {}, {{"x", "y - 0.5*x'"}}, {{"d", "y = 0.1*sin(3*t)"}}},
           state({0, 0}, {0, 0.3}));
  is_found({{"x"}, "x'^2/2", "2*x^2", {}, {}, {{"x", "if(sin(3*t) >= 0, 1, -1) - 0.5*x'"}}, {}},
           state({0}, {0}));
  question.modulo = mechanics::Vector{{2 * std::acos(-1.0), 0}};
  is_found({{"x", "y"}, "(x'^2+y'^2)/2", "2*y^2", {}, {}, {{"y", "sin(x) - 0.5*y'"}}, {{"b", "x = 3*t"}}},
           state({0, 0}, {3, 0}));
}

TEST_CASE("an equilibrium has no period of its own") {
  OrbitQuestion question;
  question.is_free = true;
  const auto damped = system({{"x"}, "x'^2/2", "x^2/2 + x", {}, {}, {{"x", "-0.1*x'"}}, {}});
  const Orbit found = find_orbit(*damped, state({-0.9}, {0}), question);
  CHECK_FALSE(found.is_found);
  CHECK(found.why.find("equilibrium") != std::string::npos);
  // Small orbits, and those far from 0, are none.
  for (const auto& [force, x] : {std::pair{"-sin(x)", 1e-7}, std::pair{"-(x-1e6)*(1+(x-1e6)^2)", 1e6 + 0.05}})
    CHECK(find_orbit(*system({{"x"}, "x'^2/2", "", {}, {}, {{"x", force}}, {}}), state({x}, {0}), question)
              .is_found);
}

TEST_CASE("a forced linear oscillator has the multipliers exp(lambda T)") {
  const SystemText text{{"x"}, "x'^2", "9*x^2", {}, {}, {{"x", "5*cos(2.5*t) - 0.8*x'"}}, {}};
  const auto made = system(text);
  OrbitQuestion question;
  question.period = 2 * std::acos(-1.0) / 2.5;
  const Orbit found = find_orbit(*made, state({0.5}, {0}), question);
  REQUIRE(found.is_found);
  CHECK(std::abs(found.start.q[0] - 0.8029197080291970802919708) <= 1e-13);
  const std::complex<double> lambda(-0.2, std::sqrt(9 - 0.04));
  REQUIRE(found.multipliers);
  CHECK(std::abs((*found.multipliers)[0] - std::exp(lambda * question.period)) <= 1e-13);
  CHECK(found.is_stable);
}

TEST_CASE("an orbit of unknown period is found, with a 1 along it") {
  const SystemText text{{"x"}, "x'^2/2", "x^2/2", {}, {}, {{"x", "-(x^2 + x'^2 - 1)*x'"}}, {}};
  const auto made = system(text);
  OrbitQuestion question;
  question.is_free = true;
  const Orbit found = find_orbit(*made, state({0.95}, {0.1}), question);
  REQUIRE(found.is_found);
  const double turn = 2 * std::acos(-1.0);
  CHECK(std::abs(found.period - turn) <= 1e-11);
  REQUIRE(found.multipliers);
  CHECK(std::abs((*found.multipliers)[0] - 1.0) <= 1e-9);
  CHECK(std::abs((*found.multipliers)[1] - std::exp(-turn)) <= 1e-9);
  CHECK(found.is_stable);
}

TEST_CASE("a motion that never comes back is no orbit") {
  const auto falls = system(ball());
  OrbitQuestion question;
  question.period = 1;
  const Orbit none = find_orbit(*falls, state({1000}, {0}), question);
  CHECK_FALSE(none.is_found);
  CHECK_FALSE(none.why.empty());
}

TEST_CASE("an orbit on two-sided constraints has the multipliers of the one in coordinates that hold them") {
  // A driven pendulum by its angle; by x and y on a rod; and with the rod said twice.
  const auto by_angle = system({{"a"}, "a'^2/2", "-cos(a)", {}, {}, {{"a", "0.5*cos(2*t) - 0.3*a'"}}, {}});
  SystemText text{{"x", "y"}, "(x'^2 + y'^2)/2", "y", {}, {}, {}, {{"rod", "x^2 + y^2 = 1"}}};
  text.forces = {{"x", "-y*(0.5*cos(2*t) - 0.3*(x*y' - y*x'))"},
                 {"y", "x*(0.5*cos(2*t) - 0.3*(x*y' - y*x'))"}};
  OrbitQuestion question;
  question.period = std::acos(-1.0);
  const Orbit angle = find_orbit(*by_angle, state({-0.15}, {0.05}), question);
  REQUIRE(angle.is_found);
  REQUIRE(angle.multipliers);
  for (const bool twice : {false, true}) {
    if (twice) text.constraints.push_back({"again", "sqrt(x^2 + y^2) = 1"});
    const auto by_rod = system(text);
    const Orbit rod = find_orbit(*by_rod, state({-0.15, -0.99}, {0.05, 0}), question);  // not quite on it
    REQUIRE(rod.is_found);
    CHECK(std::abs(rod.start.q[0] - std::sin(angle.start.q[0])) <= 1e-11);
    CHECK(std::abs(rod.start.q.norm() - 1) <= 1e-15);
    REQUIRE(rod.multipliers);
    REQUIRE(rod.multipliers->size() == 2);
    for (std::size_t k = 0; k < 2; ++k)
      CHECK(std::abs((*rod.multipliers)[k] - (*angle.multipliers)[k]) <= 1e-10);
    CHECK(rod.is_stable);
  }
}

TEST_CASE("of a family of orbits by their energy, the one of the guess is found") {
  // The pendulum let go at an angle: its period is 4 K(sin(angle/2)), another one for each angle.
  const auto made = system({{"a"}, "a'^2/2", "-cos(a)", {}, {}, {}, {}});
  OrbitQuestion question;
  question.is_free = true;
  for (const double angle : {0.3, 1.0, 2.5, 3.1}) {
    const Orbit found = find_orbit(*made, state({angle}, {0}), question);
    REQUIRE(found.is_found);
    CHECK(std::abs(found.period / (4 * std::comp_ellint_1(std::sin(angle / 2))) - 1) <= 1e-12);
    CHECK(std::abs(found.start.q[0] - angle) <= 1e-12);
    CHECK_FALSE(found.is_stable);
    CHECK(found.is_neutral);
  }
  // Beside the saddle errors grow on the way, by up to 2 / (pi - angle), before they shrink again.
  for (const double angle : {3.11, 3.12, 3.13, 3.135, 3.14}) {
    const Orbit found = find_orbit(*made, state({angle}, {0}), question);
    REQUIRE(found.is_found);
    CHECK(found.is_neutral);
  }
  // Between walls that give all of it back, and a guess that is not on the orbit of the energy asked for.
  const SystemText walls{{"x"}, "x'^2/2", "x^2/2", {}, {}, {}, {{"left", "x >= -1"}, {"right", "x <= 1"}}};
  question.motion = restitution(walls, 1);
  question.energy = 2.0;
  const Orbit bounces = find_orbit(*system(walls), state({0.1}, {1.9}), question);
  REQUIRE(bounces.is_found);
  CHECK(bounces.impacts.size() == 2);
  CHECK(std::abs(bounces.period - 4 * std::asin(0.5)) <= 1e-12);
}

TEST_CASE("an orbit told from another instant is the same one; on an impact it is told after it") {
  const SystemText text = pair("1", "1", "2*pi");
  const auto made = system(text);
  OrbitQuestion question;
  question.motion = restitution(text, 0.7);
  question.period = 1;
  const Orbit found = find_orbit(*made, state({0.28334}, {-7.9043}, 0.5), question);
  REQUIRE(found.is_found);
  CHECK(found.quiet_margin == doctest::Approx(0.25));
  for (const double t : {0.9, 0.5 + 1e-3, -3.2, 17.5}) {
    const Orbit from = orbit_from(*made, found, question, t);
    CHECK(from.start.t == t);
    CHECK(from.residual <= 1e-12);
    REQUIRE(from.impacts.size() == 2);
    for (const MotionEvent& impact : from.impacts) {
      CHECK(impact.t > t);
      CHECK(impact.t <= t + 1);
    }
  }
  const double hit = found.impacts[0].t;
  const Orbit after = orbit_from(*made, found, question, hit);
  CHECK((after.start.v - found.impacts[0].velocity_after).norm() <= 1e-12);
  // With the time of the guess on the impact the map there has no derivative, and the orbit is found all the
  // same.
  State guess = after.start;
  guess.q[0] += 1e-3;
  const Orbit there = find_orbit(*made, guess, question);
  REQUIRE(there.is_found);
  CHECK(there.start.t == hit);
  CHECK((there.start.v - after.start.v).norm() <= 1e-9);
  REQUIRE(there.multipliers);
  CHECK(std::abs((*there.multipliers)[0] - 3.44640644840723306477424) <= 1e-12);
}

TEST_CASE("a pendulum that turns over comes back up to a turn, and its free period is found") {
  // a'^2/2 - cos(a) = E > 1: a turn takes 4/sqrt(2 (E + 1)) K(k), k^2 = 2/(E + 1).
  const auto made = system({{"a"}, "a'^2/2", "-cos(a)", {}, {}, {}, {}});
  const double pi = std::acos(-1.0);
  OrbitQuestion question;
  question.is_free = true;
  question.modulo = Vector::Constant(1, 2 * pi);
  for (const double speed : {2.5, -2.5, 8.0}) {
    const Orbit found = find_orbit(*made, state({1}, {speed}), question);
    REQUIRE(found.is_found);
    const double E = speed * speed / 2 - std::cos(1.0);
    const double turn = 4 / std::sqrt(2 * (E + 1)) * std::comp_ellint_1(std::sqrt(2 / (E + 1)));
    CHECK(std::abs(found.period / turn - 1) <= 1e-12);
  }
  // Under a torque with drag one turn attracts.
  const auto driven = system({{"a"}, "a'^2/2", "-cos(a)", {}, {}, {{"a", "1.2 - 0.3*a'"}}, {}});
  const Orbit found = find_orbit(*driven, state({0}, {4}), question);
  REQUIRE(found.is_found);
  CHECK(found.is_stable);
  CHECK(found.period == doctest::Approx(1.6).epsilon(0.1));
}

TEST_CASE("a free period is found from a state that stands on a contact and leaves it") {
  // r'' = 10 - 6 r from the stop with speed 1: it is there again after 2 acos(1/sqrt(7))/sqrt(6).
  const SystemText text{{"r"}, "(r'^2 + 4*r^2)/2", "5*(r-1)^2", {}, {}, {}, {{"stop", "r <= 1.5"}}};
  const auto made = system(text);
  OrbitQuestion question;
  question.motion = restitution(text, 1);
  question.is_free = true;
  const double period = 2 * std::acos(1 / std::sqrt(7.0)) / std::sqrt(6.0);
  for (const double speed : {-1.0, 1.0}) {  // with speed 1 an impact is due
    const Orbit found = find_orbit(*made, state({1.5}, {speed}), question);
    REQUIRE(found.is_found);
    CHECK(std::abs(found.period / period - 1) <= 1e-12);
    CHECK(found.impacts.size() == 1);
    CHECK(found.multipliers);
  }
}

TEST_CASE("why no orbit is found says where the motions tried end") {
  const auto made =
      system({{"x"}, "x'^2/2", "x^2/2", {}, {}, {{"x", "0.45*cos(1.3*t) - 0.3*sign(x') - 0.1*x'"}}, {}});
  OrbitQuestion question;
  question.period = 2 * std::acos(-1.0) / 1.3;
  const Orbit none = find_orbit(*made, state({-4}, {0.5}), question);
  CHECK_FALSE(none.is_found);
  CHECK(none.why.find("dry friction") != std::string::npos);
}

TEST_CASE("a motion that loses a little energy in a graze, and has nothing to bring it back, is no orbit") {
  // A stop at the amplitude of motions of known period, reached a little too fast, right, or not at all.
  const double pi = std::acos(-1.0);
  struct Scene {
    SystemText text;
    State at;
    double period;
  };
  const std::vector<Scene> scenes{
      {{{"x"}, "x'^2/2", "2*x^2", {}, {}, {}, {{"stop", "x <= 0.5"}}}, state({0}, {1}), pi},
      {{{"a"}, "a'^2/2", "-9.81*cos(a)", {}, {}, {}, {{"stop", "a <= 0.5"}}},
       state({-0.5}, {0}),
       4 * std::comp_ellint_1(std::sin(0.25)) / std::sqrt(9.81)},
      {{{"x", "y"}, "x'^2/2 + y'^2", "2*(x - y)^2 + x^2/2 + y^2", {}, {}, {}, {{"stop", "y - x <= 0.3"}}},
       state({0.2, -0.1}, {0, 0}),
       2 * pi / std::sqrt(7.0)}};
  for (std::size_t k = 0; k < scenes.size(); ++k)
    for (const double larger : {-1e-6, -1e-9, 0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.5}) {
      CAPTURE(k);
      CAPTURE(larger);
      const auto made = system(scenes[k].text);
      State guess = scenes[k].at;
      guess.q *= 1 + larger;
      guess.v *= 1 + larger;
      for (const double e : {0.5, 0.8, 0.9999}) {
        OrbitQuestion question;
        question.motion = restitution(scenes[k].text, e);
        question.is_free = true;
        const Orbit free = find_orbit(*made, guess, question);
        question.is_free = false;
        question.period = scenes[k].period;
        const Orbit given = find_orbit(*made, guess, question);
        for (const Orbit* orbit : {&free, &given}) {
          CHECK((!orbit->is_found || orbit->impacts.empty()));
          if (orbit->is_found) CHECK_FALSE(orbit->is_stable);
          if (larger > 0) CHECK((orbit->is_found || orbit->why.find("stop") != std::string::npos));
        }
        if (larger <= 0) CHECK(free.is_found);
        if (larger >= 1e-9) CHECK_FALSE(free.is_found);
        if (free.is_found) CHECK(std::abs(free.period / scenes[k].period - 1) <= 1e-7);
      }
    }
}

TEST_CASE("a graze of a self-excited motion is an orbit where its impact repeats, and else is said") {
  // Its circle has the radius 1 and the period 2 pi, which an impact of the speed w shortens by the order w.
  const double left = std::exp(-0.2 * std::acos(-1.0));  // of 1 - r, after a round
  bool was_said = false;
  for (const double within : {1e-4, 1e-6, 1e-8, 1e-10, 1e-11, 1e-12, 1e-13}) {
    CAPTURE(within);
    std::ostringstream stop;
    stop << "x <= 1 - " << within;
    const SystemText text{
        {"x"}, "x'^2/2", "x^2/2", {}, {}, {{"x", "0.1*(1 - x^2 - x'^2)*x'"}}, {{"stop", stop.str()}}};
    OrbitQuestion question;
    question.motion = restitution(text, 0.5);
    question.is_free = true;
    const Orbit found = find_orbit(*system(text), state({0}, {1}), question);
    if (within >= 1e-10) CHECK(found.is_found);
    if (!found.is_found) {
      was_said = true;
      CHECK(found.why.find("stop") != std::string::npos);
      continue;
    }
    // To first order in 1 - r: (1 - r) before the impact is left (1 - r + 3/4 (within - (1 - r))).
    REQUIRE(found.impacts.size() == 1);
    const double speed = found.impacts[0].velocity_before[0] - found.impacts[0].velocity_after[0];
    CHECK(speed / std::sqrt(within) ==
          doctest::Approx(1.5 * std::sqrt(2 * (1 - 0.75 * left / (1 - 0.25 * left)))).epsilon(2e-2));
  }
  CHECK(was_said);
}
