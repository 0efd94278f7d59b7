#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/singular/resolution.hpp"
#include "tests/mechanics/singular_answer.hpp"

using namespace mechanics;
using tests::Answer;
using tests::answer;

TEST_CASE("a constraint is redundant where it is on the branch of the state, whatever it is on others") {
  // sin(g) = 0 also holds where g = pi, a third of the radius away, and g is not 0 there.
  for (const double l : {1.5, 4.7252, 10.0})
    for (const double angle : {0.3, 1.1}) {
      CAPTURE(l);
      const auto bead = tests::system(
          {{"x", "y"},
           "(x'^2 + y'^2)/2",
           "9.81*y",
           {{"l", std::to_string(l)}},
           {},
           {},
           {{"wave", "sin(x^2 + y^2 - l^2) = 0"}, {"circle", "(x^2 + y^2 - l^2)*(2 + cos(x*y)) = 0"}}});
      const Answer found = answer(*bead, tests::state({l * std::cos(angle), l * std::sin(angle)}, {0, 0}));
      CHECK(found.solution.primal.status == convex::Status::solved);
      CHECK(found.resolution.added.empty());
      // Along the circle alone: -9.81 cos(angle).
      CHECK(std::abs(found.q2()[1] + 9.81 * std::cos(angle) * std::cos(angle)) <= 1e-12);
    }
}
