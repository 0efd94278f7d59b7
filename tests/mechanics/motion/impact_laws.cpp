#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "convex/invalid_input.hpp"
#include "mechanics/motion/impact.hpp"
#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;
using convex::Matrix;
using convex::Metric;

namespace {

/// n equal balls in a row, all touching, the first at speed 1.
ImpactOutcome cradle(Index n, double e) {
  std::vector<ImpactContact> contacts;
  for (Index k = 0; k + 1 < n; ++k) {
    Vector u = Vector::Zero(n);
    u[k] = -1;
    u[k + 1] = 1;
    contacts.push_back({u, k == 0 ? -1.0 : 0.0, e, false});
  }
  return impact(Metric::identity(n), contacts);
}

}  // namespace

TEST_CASE("Newton's cradle under Moreau's law: the first ball turns back, the others go on as one") {
  for (const Index n : {3, 5, 12}) {
    const ImpactOutcome found = cradle(n, 1);
    const double size = static_cast<double>(n);
    CHECK(found.change[0] + 1 == doctest::Approx((2 - size) / size).epsilon(1e-14));
    for (Index k = 1; k < n; ++k) CHECK(found.change[k] == doctest::Approx(2 / size).epsilon(1e-14));
  }
}

TEST_CASE("with one e and all contacts closing v+ is -e v- + (1 + e) proj_V v-") {
  // A wedge with three redundant walls, in a metric that couples the coordinates.
  const Metric A = Metric::dense(Matrix{{2, 1}, {1, 3}});
  const Vector before{{-1, -2}};
  for (const double e : {0.0, 0.4, 1.0}) {
    std::vector<ImpactContact> contacts, plastic;
    for (const Vector& u : {Vector{{1, 0}}, Vector{{0, 1}}, Vector{{1, 1}}}) {
      contacts.push_back({u, u.dot(before), e, false});
      plastic.push_back({u, u.dot(before), 0, false});
    }
    const Vector v = before + impact(A, contacts).change, projected = before + impact(A, plastic).change;
    CHECK((v - (-e * before + (1 + e) * projected)).norm() <= 1e-14);
    CHECK(A.norm(v) <= A.norm(before) * (1 + 1e-15));
    if (e == 1) CHECK(A.norm(v) == doctest::Approx(A.norm(before)).epsilon(1e-14));
  }
}

TEST_CASE("a contact that opens before the impact counts with e = 0, and a two-sided one is held") {
  const Metric A = Metric::identity(2);
  // Opening at rate 3, closing at rate 2, orthogonal: the first is left alone.
  const ImpactOutcome apart = impact(A, {{Vector{{1, 0}}, 3, 1, false}, {Vector{{0, 1}}, -2, 0.5, false}});
  CHECK(apart.change == Vector{{0, 3}});
  CHECK(apart.rate[1] == doctest::Approx(1));
  const ImpactOutcome held = impact(A, {{Vector{{1, 1}}, 0, 1, true}, {Vector{{0, 1}}, -2, 0.5, false}});
  CHECK(held.change.isApprox(Vector{{-3, 3}}, 1e-14));
  CHECK(held.rate[0] == 0);
}

TEST_CASE("a contact that opens at the start does not close by the impact of another") {
  // In the corner of x >= 0 and y >= x, moving up and to the left: y - x opens, x closes.
  const SystemText text{
      {"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"left", "x >= 0"}, {"slope", "y >= x"}}};
  const Followed found = followed(text, state({0, 0}, {-2, -1}), 1, restitution(text, 1));
  CHECK(found.motion.status() == MotionStatus::done);
  CHECK(found.motion.record().largest_penetration == 0);
  CHECK(found.end().q[1] >= found.end().q[0]);
}

TEST_CASE("a gradient that is 0 but for rounding takes no impulse and holds nothing") {
  // sin(a) <= 1 always holds, and its gradient at π/2, 6e-17 in doubles, is 0.
  const double upright = std::acos(0.0);
  const SystemText struck{
      {"a", "b"}, "(a'^2 + b'^2)/2", "", {}, {}, {}, {{"reach", "sin(a) <= 1"}, {"stop", "a + b >= pi/2"}}};
  const SystemText pushed{
      {"b"}, "b'^2/2", "", {}, {}, {}, {{"reach", "sin(b) <= 1"}, {"piston", "b >= pi/2 + t"}}};
  const SystemText pulled{{"a"}, "a'^2/2", "", {}, {}, {{"a", "1"}}, {{"ceiling", "2*sin(a) <= 2"}}};
  for (const MotionMethod method : {MotionMethod::event_driven, MotionMethod::time_stepping}) {
    MotionOptions options = restitution(struck, 0.5);
    options.method = method;
    options.step = 1e-3;
    const Followed hit = followed(struck, state({upright, 0}, {1, -3}), 0.1, options);
    CHECK(hit.end().v[0] == doctest::Approx(2.5).epsilon(1e-12));
    CHECK(hit.end().v[1] == doctest::Approx(-1.5).epsilon(1e-12));
    options.restitution = Vector::Zero(2);
    const Followed lever = followed(pushed, state({upright}, {0}), 0.1, options);
    CHECK(lever.motion.status() == MotionStatus::done);
    CHECK(lever.end().v[0] == doctest::Approx(1).epsilon(1e-9));
    options.restitution = Vector::Zero(1);
    const Followed rod = followed(pulled, state({upright}, {0}), 1, options);
    CHECK(rod.end().q[0] == doctest::Approx(upright + 0.5).epsilon(1e-3));
  }
}

TEST_CASE("what closes within the contact tolerance at the start has a part in the first impact") {
  // near is struck at 2e-10, which counts as 0 by itself; e = 1 gives v+ = (-2, 3) all the same.
  const SystemText slow{
      {"a", "x"}, "(a'^2 + x'^2)/2", "", {}, {}, {}, {{"near", "-1e-10*a >= 0"}, {"block", "x + a >= 0"}}};
  const Followed near = followed(slow, state({0, 0}, {2, -3}), 0.1, restitution(slow, 1));
  CHECK(near.end().v[0] == doctest::Approx(-2));
  CHECK(near.end().v[1] == doctest::Approx(3));
}

TEST_CASE("no velocity satisfies walls that close on each other: the two are named") {
  const ImpactOutcome found =
      impact(Metric::identity(1), {{Vector{{1}}, -1, 0, false}, {Vector{{-1}}, -1, 0, false}});
  CHECK(found.excluding == std::vector<Index>{0, 1});
  const SystemText squeeze{{"x"}, "x'^2/2", "", {}, {}, {}, {{"left", "x >= t"}, {"right", "x <= 2 - t"}}};
  const Followed caught = followed(squeeze, state({1}, {0}), 3);
  CHECK(caught.motion.status() == MotionStatus::infeasible);
  CHECK(caught.motion.excluding() == std::vector<Index>{0, 1});
  CHECK(caught.end().t == doctest::Approx(1));
}

TEST_CASE(
    "a contact whose gradient vanishes stops a motion, and is not told as one that excludes all others") {
  const SystemText cubed{{"y"}, "y'^2/2", "y", {}, {}, {}, {{"floor", "y^3 >= 0"}}};
  const Followed found = followed(cubed, state({0}, {0}), 1);
  CHECK(found.motion.status() == MotionStatus::stopped);
  CHECK(found.motion.excluding().empty());
  // Where it is what rounding leaves of a difference, a soft contact took all of the velocity.
  for (const char* floor : {"y - sin(y) >= 0", "y - tanh(y) >= 0", "y*(1 - cos(y)) >= 0"}) {
    const SystemText flat{{"y"}, "y'^2/2", "y", {}, {}, {}, {{"floor", floor}}};
    const Followed fall = followed(flat, state({1}, {0}), 4, restitution(flat, 0.5));
    CHECK(fall.motion.status() == MotionStatus::stopped);
    CHECK(fall.motion.why().find("vanishes") != std::string::npos);
    CHECK(fall.end().t == doctest::Approx(std::sqrt(2)).epsilon(1e-3));
  }
  // A power hides it: f is 0 within rounding long before the gradient is, and the time of its zero is as
  // open.
  const SystemText disc{
      {"x", "y"}, "(x'^2 + y'^2)/2", "10*y", {}, {}, {}, {{"disc", "(x^2 + y^2 - 1)^3 >= 0"}}};
  const Followed met = followed(disc, state({0.1, 2}, {0, 0}), 2, restitution(disc, 0.5));
  CHECK(met.motion.status() == MotionStatus::stopped);
  CHECK(met.motion.why().find("vanishes") != std::string::npos);
  CHECK(met.end().t == doctest::Approx(std::sqrt((2 - std::sqrt(0.99)) / 5)).epsilon(1e-13));
  // That of a constraint on t alone is 0 everywhere: nothing meets it.
  const SystemText timed{{"y"}, "y'^2/2", "y", {}, {}, {}, {{"end", "1 - (t - 1)^2 >= 1"}}};
  CHECK(followed(timed, {1, Vector{{0}}, Vector{{0}}}, 2).motion.status() == MotionStatus::infeasible);
}

TEST_CASE(
    "a motion goes on through a place where a contact's gradient vanishes and its second derivative opens "
    "it") {
  const double upright = std::acos(-1.0) / 2;
  for (const char* reach : {"sin(a) <= 1", "(a - pi/2)^2 >= 0", "1 - cos(a - pi/2)^2 >= 0"}) {
    CAPTURE(reach);
    const SystemText crank{{"a"}, "a'^2/2", "", {}, {}, {}, {{"reach", reach}}};
    for (const double e : {0.0, 0.5, 1.0}) {
      const Followed found = followed(crank, state({upright - 0.5}, {1}), 1, restitution(crank, e));
      CHECK(found.motion.status() == MotionStatus::done);
      CHECK(found.motion.record().impacts == 0);
      CHECK(found.end().q[0] == doctest::Approx(upright + 0.5).epsilon(1e-14));
      CHECK(found.end().v[0] == doctest::Approx(1).epsilon(1e-14));
    }
    // In steps so short that one ends where f is within the contact tolerance and its gradient is not 0.
    MotionOptions options = restitution(crank, 1);
    options.method = MotionMethod::time_stepping;
    options.step = 1e-5;
    const Followed stepped = followed(crank, state({upright - 0.0101}, {1}), 0.02, options);
    CHECK(stepped.end().v[0] == doctest::Approx(1).epsilon(1e-9));
  }
  // A gradient that large terms hide is none that vanishes: f = x, which no body passes.
  const SystemText hidden{
      {"x", "y"}, "(x'^2 + y'^2)/2", "-0.1*x", {}, {}, {}, {{"wall", "sqrt(y^2)*x - (y-1)*x >= 0"}}};
  const Followed met = followed(hidden, state({0.5, 3e8}, {-1, 0}), 0.7);
  CHECK(met.end().q[0] >= -1e-9);
  // Where f'' has the other sign, or is 0, nothing tells what becomes of it, and no velocity is lost.
  for (const char* wall : {"(a - pi/2)^3 <= 0", "a - pi/2 <= sin(a - pi/2)"}) {
    const SystemText stop{{"a"}, "a'^2/2", "", {}, {}, {}, {{"wall", wall}}};
    const Followed found = followed(stop, state({upright - 0.5}, {1}), 1);
    CHECK(found.motion.status() == MotionStatus::stopped);
    CHECK(found.motion.why().find("vanishes") != std::string::npos);
    CHECK(found.end().v[0] == doctest::Approx(1));
  }
}

TEST_CASE("a motion that grows without bound stops while its energy is a double") {
  const SystemText text{{"x"}, "x'^2/2", "-1e3*x^2", {}, {}, {}, {}};
  const Followed found = followed(text, state({0}, {1}), 100);
  CHECK(found.motion.status() == MotionStatus::stopped);
  CHECK(std::isfinite(found.motion.energy()));
  CHECK(found.end().t > 7);  // e^(44.7 t) is 1e150 there
}

TEST_CASE("the ledger of impulses has the kinetic energy that impacts take, moving walls and b included") {
  const SystemText text{
      {"x", "y"},
      "(2 + cos(x))/2*x'^2 + x'*y'/2 + y'^2 + (1 + y)*x'*cos(t)",
      "9.81*y",
      {},
      {},
      {},
      {{"floor", "y >= 0.1*sin(5*t) + 0.05*x"}, {"left", "x >= -1 + 0.1*cos(3*t)"}, {"right", "x <= 1"}}};
  MotionOptions options;
  options.restitution = Vector{{0.9, 0.5, 1}};
  const Followed found = followed(text, state({0, 1}, {1.5, 0}), 6, options);
  const MotionRecord& record = found.motion.record();
  CHECK(record.impacts > 10);
  CHECK(std::abs(record.impact_energy) > 0.1);
  CHECK(std::abs(record.impact_energy - record.ledger_energy) <= 1e-12 * static_cast<double>(record.impacts));
}

TEST_CASE("e outside 0 to 1 is refused with the constraint") {
  for (const double e : {1.1, -0.1, std::nan("")}) {
    const std::string error = error_of([&] { followed(ball(), state({1}, {0}), 1, restitution(ball(), e)); });
    CHECK(error.find("floor") != std::string::npos);
    CHECK(error.find("0 to 1") != std::string::npos);
  }
}

TEST_CASE("impacts whose order is lost in the rounding of time, and matters, are told") {
  const SystemText text{
      {"x", "y", "z"}, "(x'^2 + 3*y'^2 + z'^2)/2", "", {}, {}, {}, {{"left", "y >= x"}, {"right", "z >= y"}}};
  MotionOptions options;
  options.restitution = Vector{{1, 1}};
  for (const double later : {1e-15, 0.0, 1e-6}) {
    CAPTURE(later);
    const Followed found = followed(text, state({-1, 0, 1 + later}, {1, 0, -1}), 2, options);
    const auto& remarks = found.motion.record().remarks;
    CHECK(std::any_of(remarks.begin(), remarks.end(), [](const MotionRemark& one) {
            return one.what.find("left and right") != std::string::npos;
          }) == (later == 1e-15));
  }
}

TEST_CASE("walls that strike a body by turns, faster and faster, without restitution, are not passed") {
  const SystemText text{{"q0", "q1", "q2"},
                        "(1.5 + 0.5*sin(q1))*q0'^2 + (1.5 + 0.5*sin(t))*q1'^2 + (1.5 + 0.5*sin(q1))*q2'^2 + "
                        "0.3*cos(q0 - q1)*q0'*q1'",
                        "q0^2 + q1^2 + q2^2 + 1/(2 + sin(q2)) + tanh(q2 + q0) + asin(sin(q2)/2)",
                        {},
                        {},
                        {{"q0", "sin(3*t)*q2 - 0.1*q0'"}},
                        {{"c0", "q2 + 0.3*q0^2 >= -0.6"}, {"c1", "q0 + 0.3*q2^2 >= -0.3"}}};
  const auto s = system(text);
  MotionOptions options;
  options.tolerance = 1e-11;
  Motion motion(*s, state({0.281, 0.227, 0.121}, {-0.482, -0.422, -0.357}), options);
  double least = 0;
  while (motion.advance(6))
    for (double part = 0; part <= 1; part += 1e-3)
      least =
          std::min(least, s->constraint_rates(motion.arc().state(part * motion.arc().length)).f.minCoeff());
  CHECK(motion.state().t == 6);
  CHECK(least >= -1e-13);
}
