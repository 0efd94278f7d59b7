#include <doctest/doctest.h>

#include <limits>

#include "convex/invalid_input.hpp"
#include "mechanics/gauss_function.hpp"
#include "mechanics/gauss_problem.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/motion/impact.hpp"
#include "mechanics/motion/motion.hpp"
#include "mechanics/motion/orbit.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace mechanics;
using namespace tests;
using convex::InvalidInput;

TEST_CASE("states, tolerances and contacts that fit no system are refused, none ends the program") {
  const auto system = lagrangian_system(lagrangian_text(
      {{"x", "y"}, "(x'^2 + y'^2)/2", "9.81*y", {}, {}, {}, {{"floor", "y >= 0"}, {"wall", "x >= 0"}}}));
  const Vector tolerance = Vector::Constant(2, 1e-9);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  const State at{0, Vector{{0, 0}}, Vector{{0, 0}}};
  for (const State& wrong :
       {State{0, Vector{{0}}, Vector{{0, 0}}}, State{0, Vector{{0, 0}}, Vector{{0}}}, State{},
        State{no_number, Vector{{0, 0}}, Vector{{0, 0}}}, State{0, Vector{{no_number, 0}}, Vector{{0, 0}}}}) {
    CHECK_THROWS_AS(gauss_problem(*system, wrong, tolerance), InvalidInput);
    for (const MotionMethod method : {MotionMethod::event_driven, MotionMethod::time_stepping}) {
      MotionOptions options;
      options.method = method;
      CHECK_THROWS_AS(Motion(*system, wrong, options), InvalidInput);
    }
  }
  for (const Vector& wrong : {Vector(), Vector{{1e-9}}, Vector{{1e-9, no_number}}, Vector{{1e-9, -1}}})
    CHECK_THROWS_AS(gauss_problem(*system, at, wrong), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(system->contact_rows(at, {2})), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(system->second_rates(at, Vector{{1}})), InvalidInput);
  Motion motion(*system, at, {});
  CHECK_THROWS_AS(motion.advance(std::numeric_limits<double>::infinity()), InvalidInput);
  const GaussProblem gauss = gauss_problem(*system, at, tolerance);
  CHECK_THROWS_AS(gauss_gradient(gauss.problem, Vector{{1}}), InvalidInput);
  GaussOptions no_method;
  no_method.method = nullptr;
  CHECK_THROWS_AS(solve(gauss.problem, no_method), InvalidInput);
  OrbitQuestion question;
  question.period = 1;
  question.modulo = Vector{{1}};
  CHECK_THROWS_AS(find_orbit(*system, at, question), InvalidInput);
  const convex::Metric A = convex::Metric::identity(2);
  for (const ImpactLaw law : impact_laws)
    for (const ImpactContact& wrong :
         {ImpactContact{Vector{{1}}, -1, 0.5}, ImpactContact{Vector{{1, 0}}, no_number, 0.5},
          ImpactContact{Vector{{1, 0}}, -1, 2}, ImpactContact{Vector{{1, no_number}}, -1, 0}})
      CHECK_THROWS_AS(impact(A, {wrong}, law), InvalidInput);
}
