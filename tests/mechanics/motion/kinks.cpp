#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace tests;
using mechanics::EventKind;
using mechanics::MotionStatus;

namespace {

/// A particle of mass 1 in the weight g.
SystemText particle_on(const std::string& constraint, const std::string& g = "0") {
  return {{"x", "y"}, "(x'^2+y'^2)/2", g + "*y", {}, {}, {}, {{"c", constraint}}};
}

Followed along_x(const std::string& kinetic, const std::string& potential, double until) {
  return followed({{"x"}, kinetic, potential, {}, {}, {}, {}}, state({0}, {1}), until);
}

}  // namespace

TEST_CASE("a ramp that begins with a kink is hit as a plane is, with its restitution") {
  // (1, 0) on the normal (-1, 1)/√2: (1 - e, 1 + e)/2 after it.
  for (const char* ramp : {"y >= max(0, x-1)", "y >= if(x>1, x-1, 0)", "min(y, y-x+1) >= 0"})
    for (const double e : {0.0, 0.5, 1.0}) {
      CAPTURE(ramp);
      CAPTURE(e);
      const SystemText text = particle_on(ramp, "1");
      const Followed motion = followed(text, state({0, 0}, {1, 0}), 1 + 1e-6, restitution(text, e));
      const auto impacts = motion.of(EventKind::impact);
      REQUIRE(impacts.size() == 1);
      CHECK(impacts[0].t == doctest::Approx(1).epsilon(1e-13));
      CHECK((impacts[0].velocity_before - mechanics::Vector{{1, 0}}).norm() <= 1e-13);
      CHECK((impacts[0].velocity_after - mechanics::Vector{{(1 - e) / 2, (1 + e) / 2}}).norm() <= 1e-13);
      CHECK(motion.motion.record().ledger_energy == doctest::Approx(-(1 - e * e) / 4).epsilon(1e-12));
      CHECK(motion.motion.record().impact_energy == doctest::Approx(-(1 - e * e) / 4).epsilon(1e-12));
    }
}

TEST_CASE("a bead on a wire with a kink strikes it, and the ledger says what that takes") {
  // Along (1, 0), then along (1, 1)/√2: (1, 1)/2.
  for (const auto law : {mechanics::ImpactLaw::moreau, mechanics::ImpactLaw::poisson}) {
    const SystemText text = particle_on("y = max(0, x-1)");
    mechanics::MotionOptions options = restitution(text, 0.7);
    options.impact_law = law;
    const Followed motion = followed(text, state({0, 0}, {1, 0}), 3, options);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK((motion.end().q - mechanics::Vector{{2, 1}}).norm() <= 1e-13);
    const auto impacts = motion.of(EventKind::impact);
    REQUIRE(impacts.size() == 1);
    CHECK(impacts[0].constraints == std::vector<mechanics::Index>{0});
    CHECK((impacts[0].velocity_before - mechanics::Vector{{1, 0}}).norm() <= 1e-13);
    CHECK((impacts[0].velocity_after - mechanics::Vector{{0.5, 0.5}}).norm() <= 1e-13);
    CHECK(motion.motion.record().impact_energy == doctest::Approx(-0.25).epsilon(1e-13));
    CHECK(motion.motion.record().ledger_energy == doctest::Approx(-0.25).epsilon(1e-13));
  }
}

TEST_CASE("a wire without a kink where its branches meet takes nothing") {
  const SystemText text = particle_on("y = if(x>1, (x-1)^2, 0)");
  const Followed motion = followed(text, state({0, 0}, {1, 0}), 2);
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.of(EventKind::impact).empty());
  CHECK(motion.motion.energy() == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("what is held with equality and jumps ends the motion with the reason") {
  for (const char* wire :
       {"y = if(x>5, 1, 0.5)", "y = 0.5 + 0*x + if(t>5, 1, 0)", "y = 0.5 + step(x-5)/1e4"}) {
    CAPTURE(wire);
    const Followed motion = followed(particle_on(wire), state({0, 0.5}, {1, 0}), 10);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(motion.motion.why().find("c jumps from 0 to ") != std::string::npos);
    CHECK(motion.end().t == doctest::Approx(5).epsilon(1e-13));
  }
}

TEST_CASE("a potential that jumps over time alone is a force that jumps, and is followed") {
  // x'' = 0 to t = 1, then -7: x = 1 + s - 7s²/2.
  const Followed pushed = along_x("x'^2/2", "if(t>1, 7*x, 0)", 2);
  CHECK(pushed.motion.status() == MotionStatus::done);
  CHECK(pushed.end().q[0] == doctest::Approx(-1.5).epsilon(1e-13));
  const Followed level = along_x("x'^2/2", "if(t>1, 7, 0)", 2);
  CHECK(level.motion.status() == MotionStatus::done);
  CHECK(level.end().v[0] == 1);
  // Over a position that time moves it is a wall.
  const Followed wall = along_x("x'^2/2", "if(x+t>2, 1, 0)", 2);
  CHECK(wall.motion.status() == MotionStatus::stopped);
  CHECK(wall.end().t == doctest::Approx(1).epsilon(1e-13));
}

TEST_CASE("a momentum that jumps with T ends the motion, though T itself does not jump") {
  const Followed later = along_x("if(t>1, 2, 1)/2*x'^2", "", 2);
  CHECK(later.motion.status() == MotionStatus::stopped);
  CHECK(later.motion.why().find("momentum") != std::string::npos);
  const SystemText crossed{{"x", "y"}, "(x'^2+y'^2)/2 + 0.3*if(x>1, 1, -1)*x'*y'", "", {}, {}, {}, {}};
  const Followed aside = followed(crossed, state({0, 0}, {1, 0}), 2);
  CHECK(aside.motion.status() == MotionStatus::stopped);
  CHECK(aside.end().q[0] == doctest::Approx(1).epsilon(1e-13));
  // A mass that changes while it rests is felt by nothing.
  const SystemText resting{{"x", "y"}, "if(x>1, 2, 1)/2*y'^2 + x'^2/2", "", {}, {}, {}, {}};
  CHECK(followed(resting, state({0, 0}, {1, 0}), 2).motion.status() == MotionStatus::done);
}

TEST_CASE("a force that jumps releases no curved contact that stays pressed") {
  struct Held {
    const char *potential, *force, *contact;
    mechanics::State start;
  };
  // In a bowl, under a string and over a bump: what is held is 0 but for rounding, of whichever sign.
  const Held scenes[] = {{"9.81*y", "-0.3*sign(x)", "y >= x^2/2", state({1, 0.5}, {-0.5, -0.5})},
                         {"9.81*y", "-0.3*sign(x')", "y >= x^2/2", state({1, 0.5}, {-0.5, -0.5})},
                         {"9.81*y", "if(x > 0, -0.3, 0.2)", "y >= x^2/2", state({1, 0.5}, {-0.5, -0.5})},
                         {"9.81*y + 0.3*abs(x)", "0", "y >= x^2/2", state({1, 0.5}, {-0.5, -0.5})},
                         {"9.81*y", "-0.2*sign(x')", "x^2+y^2 <= 25", state({3, -4}, {0, 0})},
                         {"9.81*y", "-3*sign(x)", "y >= -x^2/20", state({-1, -0.05}, {2, 0.2})}};
  for (const Held& scene : scenes) {
    CAPTURE(std::string(scene.potential) + ", " + scene.force + ", " + scene.contact);
    SystemText text{{"x", "y"}, "(x'^2+y'^2)/2",      scene.potential,       {},
                    {},         {{"x", scene.force}}, {{"c", scene.contact}}};
    const Followed motion = followed(text, scene.start, 5);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.of(EventKind::branch).size() == motion.events.size());
    CHECK(!motion.events.empty());
    CHECK(motion.motion.record().remarks.empty());
    std::string& relation = text.constraints.front().second;
    relation.erase(relation.find_first_of("<>"), 1);  // held with equality
    const Followed held = followed(text, scene.start, 5);
    CHECK((motion.end().q - held.end().q).norm() <= 1e-9);
    CHECK(motion.events.size() == held.events.size());
  }
}

TEST_CASE("a contact that a jump of the force pulls off is released there, and no other") {
  // Beyond x = 1 a lift of 20 takes the particle off the first floor; the second, of its own y, stays
  // pressed.
  const SystemText text{{"x", "y", "z"},
                        "(x'^2+y'^2+z'^2)/2",
                        "9.81*(y + z)",
                        {},
                        {},
                        {{"y", "if(x > 1, 20, 0)"}},
                        {{"left", "y >= x^2/2"}, {"kept", "z >= x^2/4"}}};
  const Followed motion = followed(text, state({0, 0, 0}, {5, 0, 0}), 0.5);
  const auto released = motion.of(EventKind::release);
  REQUIRE(released.size() == 1);
  CHECK(released.front().constraints == std::vector<mechanics::Index>{0});
  CHECK(motion.of(EventKind::impact).empty());
}

TEST_CASE("in a steep groove of one constraint a particle strikes one side after the other") {
  // Sides of slope 3 at one point: each impact turns the velocity about one of them, until it leads away.
  const SystemText text = particle_on("y >= 3*abs(x)", "1");
  for (const double e : {0.5, 1.0}) {
    const Followed motion = followed(text, state({-1, 3}, {1, -3}), 1.5, restitution(text, e));
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.of(EventKind::impact).size() >= 2);
    CHECK(motion.end().q[1] >= 3 * std::abs(motion.end().q[0]) - 1e-15);
    const double lost = motion.motion.record().ledger_energy;
    CHECK(motion.motion.energy() - lost == doctest::Approx(8).epsilon(1e-12));
    CHECK((e < 1 || std::abs(lost) <= 1e-14));
  }
  // With e = 0 there is always one more, ever slower.
  const Followed slower = followed(text, state({-1, 3}, {1, -3}), 1.5, restitution(text, 0));
  CHECK(slower.motion.status() == MotionStatus::stopped);
  CHECK(slower.motion.why().find("y >= -x") != std::string::npos);
}

TEST_CASE("at rest at the bottom of a groove in one constraint a body stays, and is not pushed aside there") {
  const SystemText text = particle_on("y >= abs(x)", "1");
  const Followed motion = followed(text, state({-1, 1}, {1, -1}), 3, restitution(text, 0));
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.end().q.norm() <= 1e-15);
  CHECK(motion.motion.multipliers()[0] == doctest::Approx(1));
  // The sides of the groove hold it against a small force, and one constraint has but one of them.
  SystemText pushed = text;
  pushed.forces = {{"x", "0.1"}};
  const Followed stopped = followed(pushed, state({-1, 1}, {1, -1}), 3, restitution(pushed, 0));
  CHECK(stopped.motion.status() == MotionStatus::stopped);
  CHECK(stopped.motion.why().find("kink") != std::string::npos);
  CHECK(stopped.motion.why().find("y >= -x") != std::string::npos);
}

TEST_CASE("an angle wrapped by atan2 jumps at its cut, and the motion goes on behind it") {
  // On each turn a harmonic motion about its middle: A sin(t + phase), A² = 2 (T + V).
  const SystemText text{{"a"}, "a'^2/2", "atan2(sin(a), cos(a))^2/2", {}, {}, {}, {}};
  const double pi = std::acos(-1.0), until = 20;
  for (const double speed : {50.0, 5.0, -20.0}) {
    CAPTURE(speed);
    const Followed motion = followed(text, state({0.5}, {speed}), until);
    REQUIRE(motion.motion.status() == MotionStatus::done);
    const double A = std::sqrt(speed * speed + 0.25), quarter = std::asin(pi / A),
                 way = std::copysign(1.0, speed);
    const double since = until + std::asin(way * 0.5 / A) + quarter;  // the beginning of the first turn
    const double turns = std::floor(since / (2 * quarter)), rest = since - turns * 2 * quarter;
    CHECK(motion.end().q[0] ==
          doctest::Approx(way * (2 * pi * turns + A * std::sin(rest - quarter))).epsilon(1e-10));
    CHECK(motion.motion.energy() == doctest::Approx(A * A / 2).epsilon(1e-10));
  }
}

TEST_CASE("a branch whose argument jumps with another is taken anew there") {
  // The force is -1 where x < 0 and y < 0, else 1; y stays -1.
  const SystemText text{{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"x", "sign(if(x < 0, y, 1))"}}, {}};
  const Followed motion = followed(text, state({-0.5, -1}, {2, 0}), 1);
  const double v = std::sqrt(3.0), t = 1 - (2 - v);  // at x = 0, and the time left
  CHECK(motion.end().q[0] == doctest::Approx(v * t + t * t / 2).epsilon(1e-12));
}

TEST_CASE("a motion begins on the branch of the text, where 0 is not negative") {
  // atan2(y, x) is pi at (-1, 0): the force of this potential is upwards, away from the floor.
  for (const char* floor : {"y >= 0", "y >= -1"}) {
    CAPTURE(floor);
    const Followed motion =
        followed({{"x", "y"}, "(x'^2+y'^2)/2", "atan2(y, x)^2/2", {}, {}, {}, {{"c", floor}}},
                 state({-1, 0}, {0, 0}), 1);
    CHECK(motion.end().q[1] > 1);
    CHECK(motion.motion.energy() == doctest::Approx(std::acos(-1.0) * std::acos(-1.0) / 2).epsilon(1e-12));
  }
  CHECK(followed({{"y"}, "y'^2/2", "", {}, {}, {{"y", "if(y < 0, -1, 1)"}}, {}}, state({0}, {0}), 1)
            .end()
            .q[0] == doctest::Approx(0.5));
  CHECK(followed({{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"y", "sign(if(x < 0, y, 1))"}}, {}},
                 state({0, -1}, {0, 0}), 1)
            .end()
            .q[1] == doctest::Approx(-0.5));
}

TEST_CASE("a potential that jumps where an angle does, or with another branch, stops the motion") {
  for (const SystemText& text : {SystemText{{"a"}, "a'^2/2", "max(atan2(sin(a), cos(a)), 0)", {}, {}, {}, {}},
                                 SystemText{{"a"}, "a'^2/2", "max(if(a < 3.1, a, -1), 0)", {}, {}, {}, {}}}) {
    const Followed motion = followed(text, state({3}, {3}), 1);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(motion.motion.why().find("energy jumps") != std::string::npos);
  }
}

TEST_CASE("the angle of the axis itself is 0, then pi") {
  const Followed motion =
      followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "atan2(0, t)"}}, {}}, state({0}, {0}, -1), 1);
  CHECK(motion.end().q[0] == doctest::Approx(1.5 * std::acos(-1.0)).epsilon(1e-12));
}

TEST_CASE("the root of a square is followed as the magnitude that it is") {
  const SystemText root{{"a"}, "a'^2/2", "3*sqrt((a-3)^2)", {}, {}, {}, {}},
      magnitude{{"a"}, "a'^2/2", "3*abs(a-3)", {}, {}, {}, {}};
  const auto along = [](const SystemText& text) { return followed(text, state({0.7}, {5}), 7).end().q[0]; };
  CHECK(along(root) == doctest::Approx(along(magnitude)).epsilon(1e-12));
  for (const char* other : {"sqrt(9*(a-3)^2)", "3*((a-3)^2)^0.5", "sqrt((a-3)*(a-3)/4)*6"}) {
    CAPTURE(other);
    CHECK(along({{"a"}, "a'^2/2", other, {}, {}, {}, {}}) ==
          doctest::Approx(along(magnitude)).epsilon(1e-12));
  }
}

TEST_CASE("steps that get shorter without end stop the motion with the reason") {
  const SystemText text{{"a"}, "a'^2/2", "asin(sin(a))", {}, {}, {}, {}};
  const Followed motion = followed(text, state({0.7}, {5}), 7);
  CHECK(motion.motion.status() == MotionStatus::stopped);
  CHECK(motion.motion.why().find("asin") != std::string::npos);
  CHECK(motion.end().t == doctest::Approx(0.177302894906).epsilon(1e-9));  // a = π/2
}

TEST_CASE("the angle of a point on the negative axis is pi, whatever the sign of its zero") {
  for (const char* angle : {"atan2(y, x)", "atan2(-y, x)", "atan2(-2*y, x)", "atan2(-sin(y), x)"}) {
    CAPTURE(angle);
    const auto made = system({{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"x", angle}}, {}});
    CHECK(made->inertia(state({-1, 0}, {0, 0})).z[0] == std::acos(-1.0));
  }
}

TEST_CASE("a branch goes on where another makes its argument jump off 0, or onto it") {
  struct Case {
    const char* force;
    mechanics::State start;
    double until, x, v;
  };
  const Case cases[] = {{"sign(step(x))", state({-1, 0}, {1, 0}), 3, 4, 3},
                        {"max(step(t - 1), 0)", state({-1, 0}, {1, 0}), 3, 4, 3},
                        {"if(step(t - 1) > 0, 1, 0)", state({-1, 0}, {1, 0}), 3, 4, 3},
                        {"if(sign(y) <= sign(-0.5), 1, 0)", state({0, 0.5}, {0, -1}), 1, 0.125, 0.5},
                        {"if(step(x) >= step(y), 1, 0)", state({-0.25, -0.5}, {0, 1}), 1, 0.15625, 0.75},
                        {"sign(step(y))", state({0, 0.5}, {0, -1}), 1, 0.375, 0.5},
                        {"max(sign(x), -sign(x))", state({0, 0}, {1, 0}), 2, 4, 3},
                        {"abs(sign(x))", state({0, 0}, {1, 0}), 2, 4, 3},
                        {"sign(sign(t))", state({0, 0}, {0, 0}), 1, 0.5, 1},
                        {"sqrt(sign(x)^2)", state({0, 0}, {0.5, 0}), 1, 1, 1.5}};
  for (const Case& one : cases) {
    CAPTURE(one.force);
    const Followed motion =
        followed({{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"x", one.force}}, {}}, one.start, one.until);
    CHECK(motion.end().q[0] == doctest::Approx(one.x).epsilon(1e-12));
    CHECK(motion.end().v[0] == doctest::Approx(one.v).epsilon(1e-12));
  }
}

TEST_CASE(
    "an impact at the bottom of a groove that sends a body against its other side strikes there at once") {
  // On (-4, 1) with e = 1/2: (2, -0.5) is (-1, 0.25) after it; on (1, 1): (-0.4375, 0.8125).
  SystemText groove = particle_on("y >= max(4*x, -x)");
  groove.forces = {{"x", "3"}, {"y", "0.5"}};
  const Followed motion = followed(groove, state({0, 0}, {2, -0.5}), 0.01, restitution(groove, 0.5));
  REQUIRE(motion.of(EventKind::impact).size() == 2);
  CHECK((motion.of(EventKind::impact)[1].velocity_after - mechanics::Vector{{-0.4375, 0.8125}}).norm() <=
        1e-13);
  CHECK(motion.end().v[0] == doctest::Approx(-0.4075).epsilon(1e-12));
  CHECK(motion.motion.status() == MotionStatus::done);
}

TEST_CASE("bounces come to rest on a floor at which a force has a kink") {
  for (const char* spring : {"max(y, 0)", "abs(y)", "-min(-y, 0)", "if(y > 0, y, 0)"}) {
    CAPTURE(spring);
    const SystemText text{
        {"y"}, "y'^2/2", "", {}, {}, {{"y", std::string("-9.81 - 100*") + spring}}, {{"floor", "y >= 0"}}};
    for (const double y : {0.0, 1.0}) {
      const Followed motion = followed(text, state({y}, {1 - y}), 8, restitution(text, 0.8));
      CHECK(motion.motion.status() == MotionStatus::done);
      CHECK(std::abs(motion.end().q[0]) < 1e-14);
      CHECK(motion.motion.multipliers()[0] == doctest::Approx(9.81).epsilon(1e-12));
    }
  }
}
