#include <doctest/doctest.h>

#include "mechanics/motion/motion.hpp"

using namespace mechanics;

TEST_CASE("a ball bounces until it rests") {
  LagrangianText text;
  text.coordinates = {{"y", {}}};
  text.kinetic = {"m/2*y'^2", {}};
  text.potential = Text{"m*9.81*y", {}};
  text.parameters = {{{"m", {}}, {"2", {}}}};
  text.constraints = {{{"floor", {}}, {"y >= 0", {}}}};
  const auto system = lagrangian_system(text);

  MotionOptions options;
  options.restitution = Vector{{0.9}};
  Motion motion(*system, State{0, Vector{{1}}, Vector{{0}}}, options);
  double highest_after_four = 0;
  MotionEvent last;
  while (motion.advance(10)) {  // one step: to the next event, or as far as a series reaches
    const Arc& arc = motion.arc();
    if (arc.t > 4)
      for (const double part : {0.25, 0.5, 0.75})  // the step is its own dense output
        highest_after_four = std::max(highest_after_four, arc.position(part * arc.length)[0]);
    if (!motion.events().empty()) last = motion.events().back();
  }
  CHECK(motion.status() == MotionStatus::done);
  CHECK(highest_after_four < 0.36);
  // Infinitely many impacts end at t_1 (1 + e)/(1 - e), t_1 = sqrt(2/g).
  CHECK(last.kind == EventKind::accumulation);
  CHECK(last.t == doctest::Approx(8.578949178728887).epsilon(1e-15));
  CHECK(motion.state().q[0] == 0);
  CHECK(motion.multipliers()[0] == doctest::Approx(2 * 9.81).epsilon(1e-15));
  CHECK(motion.record().impact_energy == doctest::Approx(-2 * 9.81).epsilon(1e-12));
}
