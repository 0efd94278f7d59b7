#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

MotionOptions stepping(const SystemText& text, double h, double e = 0) {
  MotionOptions options = restitution(text, e);
  options.method = MotionMethod::time_stepping;
  options.step = h;
  return options;
}

}  // namespace

TEST_CASE("without contacts the error of a step falls with its square") {
  const SystemText text{{"a"}, "a'^2/2", "-9.81*cos(a)", {}, {}, {}, {}};
  const double period = 2.139137600558689;  // 4 K(sin(1/2)) / sqrt(9.81)
  double last = 0;
  for (const double parts : {200.0, 400.0, 800.0}) {
    const Followed found = followed(text, state({1}, {0}), period, stepping(text, period / parts));
    const double error = std::hypot(found.end().q[0] - 1, found.end().v[0]);
    if (last > 0) CHECK(last / error == doctest::Approx(4).epsilon(0.02));
    last = error;
  }
}

TEST_CASE("with impacts the error of a step falls with the step itself") {
  const double g = 9.81, e = 0.8, until = 1.1;
  const double first = std::sqrt(2 / g), up = e * std::sqrt(2 * g), since = until - first;
  REQUIRE(since < 2 * up / g);
  double last = 0;
  for (const double h : {1e-3, 1e-4, 1e-5}) {
    const Followed found = followed(ball(), state({1}, {0}), until, stepping(ball(), h, e));
    const double error = std::abs(found.end().q[0] - (up * since - g * since * since / 2)) +
                         std::abs(found.end().v[0] - (up - g * since));
    CHECK(error <= 2 * (1 + e) * g * h);
    if (last > 0) CHECK(error < 0.4 * last);
    last = error;
    const auto impacts = found.of(EventKind::impact);
    REQUIRE(impacts.size() == 1);
    CHECK(std::abs(impacts[0].t - first) <= 2 * h);
    CHECK(impacts[0].velocity_after[0] ==
          doctest::Approx(-e * impacts[0].velocity_before[0]).epsilon(2 * g * h));
  }
}

TEST_CASE("a ball that bounces without loss keeps its energy over a hundred impacts, whatever the step") {
  for (const double h : {1e-2, 1e-3}) {
    const Followed found = followed(ball(), state({1}, {0}), 90, stepping(ball(), h, 1));
    CHECK(found.of(EventKind::impact).size() > 95);
    CHECK(found.motion.energy() == doctest::Approx(2 * 9.81).epsilon(1e-10));
    CHECK(found.motion.record().largest_penetration <= 1e-14);
    CHECK(found.motion.record().correction_energy == doctest::Approx(0).epsilon(1e-9));
  }
}

TEST_CASE("after infinitely many impacts the ball rests with lambda = mg") {
  const Followed found = followed(ball(), state({1}, {0}), 10, stepping(ball(), 1e-3, 0.9));
  CHECK(found.end().v[0] == 0);
  CHECK(std::abs(found.end().q[0]) <= 1e-15);
  CHECK(found.motion.multipliers()[0] == doctest::Approx(2 * 9.81).epsilon(1e-12));
  // The end of the impacts in closed form: 8.5789….
  REQUIRE(!found.of(EventKind::contact).empty());
  CHECK(found.of(EventKind::contact)[0].t == doctest::Approx(8.578949178728887).epsilon(0.02));
}

TEST_CASE("contacts that move on a curve stay closed, and are left when they push no more") {
  // A particle slides off a cylinder at cos a = 2/3 (from rest at the top).
  const SystemText text{
      {"x", "y"}, "(x'^2 + y'^2)/2", "9.81*y", {}, {}, {}, {{"cylinder", "x^2 + y^2 >= 1"}}};
  const double a = 0.1;
  const State start = state({std::sin(a), std::cos(a)}, {0, 0});
  double last = 0;
  for (const double h : {2e-3, 1e-3, 5e-4}) {
    auto made = system(text);
    Motion motion(*made, start, stepping(text, h));
    double height = 0;
    while (height == 0 && motion.advance(3))
      for (const MotionEvent& event : motion.events())
        if (event.kind == EventKind::release) height = motion.state().q[1];
    CHECK(motion.record().largest_penetration <= 1e-9);
    const double error = std::abs(height - 2 * std::cos(a) / 3);
    CHECK(error <= 4 * h);
    if (last > 0) CHECK(error <= 0.8 * last);
    last = error;
  }
}

TEST_CASE("two-sided constraints hold, and the energy with them") {
  const SystemText text{{"x", "y"}, "(x'^2 + y'^2)/2", "9.81*y", {}, {}, {}, {{"rod", "x^2 + y^2 = 1"}}};
  const Followed found = followed(text, state({1, 0}, {0, 0}), 10, stepping(text, 1e-3));
  CHECK(std::abs(found.end().q.norm() - 1) <= 1e-9);
  CHECK(std::abs(found.motion.energy()) <= 1e-4);
}

TEST_CASE("a wall that moves carries a body with it") {
  const SystemText text{{"x"}, "x'^2/2", "", {}, {}, {}, {{"wall", "x >= t^2/2"}}};
  const Followed found = followed(text, state({0}, {0}), 2, stepping(text, 1e-3));
  CHECK(found.end().q[0] == doctest::Approx(2).epsilon(1e-9));
  CHECK(found.end().v[0] == doctest::Approx(2).epsilon(1e-3));
  CHECK(found.motion.multipliers()[0] == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("balls that rest in a column do so at once, and cost nothing while they rest") {
  const SystemText text{{"a", "b", "c"},
                        "(a'^2 + 2*b'^2 + 3*c'^2)/2",
                        "9.81*(a + 2*b + 3*c)",
                        {},
                        {},
                        {},
                        {{"floor", "a >= 0"}, {"first", "b >= a + 1"}, {"second", "c >= b + 1"}}};
  const Followed found = followed(text, state({0, 1, 2}, {0, 0, 0}), 1, stepping(text, 1e-2, 0.5));
  CHECK(found.events.empty());
  CHECK(found.end().v.norm() == 0);
  CHECK((found.motion.multipliers() - Eigen::Vector3d(6, 5, 3) * 9.81).norm() <= 1e-12);
}

TEST_CASE("forces that a step cannot follow end the motion with the step to take") {
  const SystemText text{{"x"}, "x'^2/2", "1e8*x^2/2", {}, {}, {}, {}};
  const Followed stiff = followed(text, state({1}, {0}), 1, stepping(text, 1e-2));
  CHECK(stiff.motion.status() == MotionStatus::stopped);
  CHECK(stiff.motion.why().find("take a shorter") != std::string::npos);
  const Followed fine = followed(text, state({1}, {0}), 1e-3, stepping(text, 1e-6));
  CHECK(fine.motion.status() == MotionStatus::done);
  CHECK(fine.end().q[0] == doctest::Approx(std::cos(10.0)).epsilon(1e-3));
}

TEST_CASE("time-stepping refuses laws of impact that it does not have, and steps that are none") {
  MotionOptions options = stepping(ball(), 1e-3);
  options.impact_law = ImpactLaw::poisson;
  CHECK_THROWS_AS(followed(ball(), state({1}, {0}), 1, options), convex::InvalidInput);
  CHECK_THROWS_AS(followed(ball(), state({1}, {0}), 1, stepping(ball(), 0)), convex::InvalidInput);
  CHECK_THROWS_AS(followed(ball(), state({1}, {0}), 1, stepping(ball(), -1)), convex::InvalidInput);
}

TEST_CASE("a contact that comes up while nothing pulls is met in steps too") {
  const SystemText text{{"x", "y"}, "x'^2/2 + 3*y'^2/2", "", {}, {}, {}, {{"blocks", "y >= x"}}};
  MotionOptions options;
  options.method = MotionMethod::time_stepping;
  options.step = 0.125;
  options.restitution = Vector{{1}};
  const Followed found = followed(text, state({1, 2}, {0, -1}), 2, options);
  REQUIRE(found.motion.status() == MotionStatus::done);
  // Momentum and energy: v = 2 u - v with u = -3/4.
  CHECK(found.end().v[0] == doctest::Approx(-1.5).epsilon(1e-14));
  CHECK(found.end().v[1] == doctest::Approx(-0.5).epsilon(1e-14));
}

TEST_CASE("a pile of very many discs overlaps nowhere, and gains no energy") {
  // More than 300 coordinates and contacts: positions are corrected to a few digits a step.
  constexpr int side = 14;
  SystemText text;
  const auto name = [](const char* axis, int i) { return axis + std::to_string(i); };
  Vector q(2 * side * side), v(2 * side * side);
  for (int i = 0; i < side * side; ++i) {
    const int row = i / side, column = i % side;
    const std::string x = name("x", i), y = name("y", i);
    text.coordinates.insert(text.coordinates.end(), {x, y});
    text.kinetic += (i > 0 ? " + " : "") + ("(" + x + "'^2 + " + y + "'^2)/2");
    text.potential += (i > 0 ? " + " : "") + ("9.81*" + y);
    q[2 * i] = column + 0.5 * (row % 2);
    q[2 * i + 1] = std::sqrt(0.75) * row;
    v[2 * i] = 0.1 * std::sin(7.0 * i);
    v[2 * i + 1] = 0.1 * std::cos(5.0 * i);
    const auto apart = [&](int j) {
      const std::string dx = name("x", j) + " - " + x, dy = name("y", j) + " - " + y;
      text.constraints.push_back({"c" + std::to_string(i) + "_" + std::to_string(j),
                                  "((" + dx + ")^2 + (" + dy + ")^2 - 1)/2 >= 0"});
    };
    if (row == 0) text.constraints.push_back({name("floor", i), y + " >= 0"});
    if (column == 0) text.constraints.push_back({name("left", i), x + " >= 0"});
    if (column + 1 == side) text.constraints.push_back({name("right", i), x + " <= 13.5"});
    if (column + 1 < side) apart(i + 1);
    if (row + 1 == side) continue;
    const int up = i + side + (row % 2 == 1 ? 0 : -1);
    if (row % 2 == 1 || column > 0) apart(up);
    if (row % 2 == 0 || column + 1 < side) apart(up + 1);
  }
  const auto made = system(text);
  Motion motion(*made, {0, q, v}, stepping(text, 1e-3));
  const double start = motion.energy();
  double last = start;
  while (motion.advance(0.03)) {
    CHECK(motion.energy() <= last + 1e-9 * start);  // e = 0, and nothing moves but the discs
    last = motion.energy();
  }
  CHECK(motion.status() == MotionStatus::done);
  CHECK(motion.record().steps == 30);
  CHECK(motion.record().largest_penetration <= 1e-7);
}

TEST_CASE("between its ends a step has the velocities of both, whatever is corrected of its position") {
  // A ball that falls on the floor within the last step: the correction lifts it, which is no velocity of the
  // step.
  const auto made = system(ball());
  Motion motion(*made, state({1}, {0}), stepping(ball(), 0.1));
  while (motion.advance(0.5)) {
    const Vector before = motion.arc().state(0).v;
    const double fallen = before[0] - 9.81 * 0.1;
    if (motion.state().q[0] > 0) CHECK(motion.state().v[0] == doctest::Approx(fallen).epsilon(1e-12));
    CHECK(before[0] == doctest::Approx(-9.81 * motion.arc().state(0).t).epsilon(1e-9));
  }
}

TEST_CASE("an accumulation that was decided before a motion goes on in steps is told at its time") {
  const auto made = system(ball());
  MotionOptions options = restitution(ball(), 0.5);
  options.step = 1e-3;
  Motion motion(*made, state({1}, {0}), options);
  long accumulations = 0;
  const auto count = [&] {
    for (const MotionEvent& event : motion.events())
      if (event.kind == EventKind::accumulation) {
        ++accumulations;
        CHECK(event.t == doctest::Approx(3 * std::sqrt(2 / 9.81)).epsilon(1e-12));
      }
  };
  while (motion.multipliers()[0] == 0 && motion.advance(3)) count();
  REQUIRE(accumulations == 0);
  motion.go_on_in_steps();
  while (motion.advance(3)) count();
  CHECK(accumulations == 1);
}

TEST_CASE("a motion that goes on in steps has the state and the record that it had") {
  const auto made = system(ball());
  MotionOptions options = restitution(ball(), 0.5);
  options.step = 1e-4;
  Motion motion(*made, state({1}, {0}), options), events(*made, state({1}, {0}), options);
  while (motion.advance(0.6)) {
  }
  const State before = motion.state();
  const long impacts = motion.record().impacts;
  REQUIRE(impacts == 1);
  motion.go_on_in_steps();
  CHECK(motion.method() == MotionMethod::time_stepping);
  CHECK(motion.state().t == before.t);
  CHECK(motion.state().q == before.q);
  CHECK(motion.state().v == before.v);
  while (motion.advance(1)) {
  }
  while (events.advance(1)) {
  }
  CHECK(motion.record().impacts == events.record().impacts);
  CHECK(std::abs(motion.state().q[0] - events.state().q[0]) <= 1e-3);
}

TEST_CASE("contacts that open at the start have a part in the impact there, in steps too") {
  // x >= 0 opens at 1, y >= x is struck at -2, both with e = 1: v+ = (0, 2).
  const SystemText corner{{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"c", "x >= 0"}, {"b", "y >= x"}}};
  const Followed found = followed(corner, state({0, 0}, {1, -1}), 0.1, stepping(corner, 1e-3, 1));
  CHECK(found.end().v[0] == doctest::Approx(0));
  CHECK(found.end().v[1] == doctest::Approx(2));
}

TEST_CASE("the energy of an impact in a moving frame is that of T with its linear terms, in steps too") {
  // T = (x' + 3)²/2: from x' = -1 to 0 it rises from 2 to 9/2.
  const SystemText frame{{"x"}, "(x' + 3)^2/2", "", {}, {}, {}, {{"buffer", "x >= 0"}}};
  const Followed found = followed(frame, state({1}, {-1}), 2, stepping(frame, 0.01));
  CHECK(found.motion.record().impact_energy == doctest::Approx(2.5));
  CHECK(found.motion.record().ledger_energy == doctest::Approx(2.5));
}
