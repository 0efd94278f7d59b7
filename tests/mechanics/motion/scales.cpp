// Contacts that do not feel each other, of scales far apart: none decides for the other.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

/// Two bodies, each with a floor of its own.
SystemText two_bodies(const std::string& potential) {
  return {{"x", "y"}, "x'^2/2 + y'^2/2", potential, {}, {}, {}, {{"wall", "x >= 0"}, {"floor", "y >= 0"}}};
}

}  // namespace

TEST_CASE("a body that opens slowly hops, however violent the impact of another at that instant is") {
  const SystemText text = two_bodies("1e-7*y");
  for (const ImpactLaw law : impact_laws) {
    MotionOptions options = restitution(text, 0.5);
    options.impact_law = law;
    const Followed found = followed(text, state({0, 0}, {-1e7, 1e-6}), 29, options);
    CAPTURE(name(law));
    REQUIRE(found.events.size() == 2);
    CHECK(found.events[0].constraints == std::vector<Index>{0});
    CHECK(found.events[0].velocity_after[0] == 5e6);
    CHECK(found.events[0].velocity_after[1] == 1e-6);
    CHECK(found.events[1].t == doctest::Approx(20).epsilon(1e-14));  // 2 v / g
    CHECK(found.events[1].velocity_after[1] == doctest::Approx(5e-7).epsilon(1e-13));
  }
}

TEST_CASE("a weak force lifts its body, and another presses it, however strong those on another body are") {
  const Followed lifted = followed(two_bodies("1e7*x - 1e-7*y"), state({0, 0}, {0, 0}), 10);
  CHECK(lifted.end().q[1] == doctest::Approx(5e-6).epsilon(1e-14));  // g t² / 2
  CHECK(lifted.motion.multipliers()[0] == 1e7);
  const Followed pressed = followed(two_bodies("1e7*x + 1e-7*y"), state({0, 0}, {0, 0}), 10);
  CHECK(pressed.end().q[1] == 0);
  CHECK(pressed.motion.multipliers()[1] == doctest::Approx(1e-7).epsilon(1e-14));
}

TEST_CASE("a ball bounces as often in any unit of length before its impacts end") {
  long impacts = 0;
  for (const double unit : {1.0, 1e-100, 1e100}) {
    const std::string gravity = unit == 1 ? "10*y" : unit < 1 ? "1e-99*y" : "1e101*y";
    const SystemText scaled{{"y"}, "y'^2/2", gravity, {}, {}, {}, {{"floor", "y >= 0"}}};
    MotionOptions options = restitution(scaled, 0.5);
    options.contact_tolerance = Vector{{1e-200}};
    const Followed found = followed(scaled, state({0.2 * unit}, {0}), 2, options);
    const auto ends = found.of(EventKind::accumulation);
    REQUIRE(ends.size() == 1);
    CHECK(ends[0].t == doctest::Approx(0.2 * (1 + 0.5) / (1 - 0.5)).epsilon(1e-14));
    if (unit == 1) impacts = found.motion.record().impacts;
    CHECK(std::abs(found.motion.record().impacts - impacts) <= 1);  // the unit is no power of 2
    CHECK(impacts > 20);
  }
}

TEST_CASE("the end of impacts that are not followed one by one is within what is told") {
  for (const double e : {0.9999, 0.99995}) {
    const SystemText text = ball();
    const Followed found = followed(text, state({0}, {1}), 1e4, restitution(text, e));
    REQUIRE(found.of(EventKind::accumulation).size() == 1);
    REQUIRE(found.motion.record().remarks.size() == 1);
    const std::string& told = found.motion.record().remarks[0].what;
    const double within = std::stod(told.substr(told.find("within ") + 7));
    const long double end = 2 / (9.81L * (1 - static_cast<long double>(e)));
    CAPTURE(told);
    CHECK(std::abs(found.of(EventKind::accumulation)[0].t - static_cast<double>(end)) <= within);
    CHECK(within < 1e-6);
  }
}

TEST_CASE("what is said again is one remark: how often, from when to when, and the worst") {
  const SystemText text{
      {"x", "y"}, "(x'^2 + y'^2)/2", "9.81*(x + y)", {}, {}, {}, {{"sooner", "x >= 0"}, {"later", "y >= 0"}}};
  MotionOptions options = restitution(text, 0);
  options.restitution = Vector{{0.9999, 0.99995}};
  const Followed found = followed(text, state({0, 0}, {1, 1}), 1e4, options);
  REQUIRE(found.of(EventKind::accumulation).size() == 2);
  const auto& remarks = found.motion.record().remarks;
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0].kind == mechanics::RemarkKind::accumulation);
  CHECK(remarks[0].count == 2);
  CHECK(remarks[0].t < remarks[0].last);
  CHECK(remarks[0].what.find("impacts of later") == 0);  // the more impacts, the more roundings
}

TEST_CASE(
    "an impact whose speed is the rounding of earlier speeds is told, and no other of Newton's cradle is") {
  const SystemText text{{"a", "b", "c"},
                        "(a'^2 + b'^2 + c'^2)/2",
                        "-9.81*(cos(a) + cos(b) + cos(c))",
                        {},
                        {},
                        {},
                        {{"first", "sin(b) >= sin(a)"}, {"second", "sin(c) >= sin(b)"}}};
  MotionOptions options = restitution(text, 1);
  options.impact_law = mechanics::ImpactLaw::sequential;
  const Followed found = followed(text, state({-0.5, 0, 0}, {0, 0, 0}), 5, options);
  // The balls that hang at rest part and meet with what rounding leaves of 1.55: some 1e-16.
  long by_rounding = 0;
  for (const MotionEvent& one : found.of(EventKind::impact))
    by_rounding += (one.velocity_before - one.velocity_after).norm() < 1e-12;
  const auto& remarks = found.motion.record().remarks;
  REQUIRE(by_rounding > 0);
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0].kind == mechanics::RemarkKind::speed);
  CHECK(remarks[0].count == by_rounding);
  CHECK(remarks[0].what.find("second closes with a speed that rounding may have made") == 0);
}
