#include "convex/nearest_point/methods/closed_form.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>

#include "convex/double_double.hpp"

using convex::Metric;
using convex::Solution;
using convex::Status;
using convex::Vector;

TEST_CASE("with one row held the bound counts the digits that a large z takes") {
  int judged = 0;
  // A = (1 a; a 1) and u q1 = s: q1 = s/u and q0 = z0 - a q1.
  for (const double a : {0.5, 0.9999999, 0.9999999999999, 0.999999999999999})
    for (const double z : {-1.0, -2e7, -3e7, -1e17})
      for (const double s : {0.1, -0.5, -1.0}) {
        CAPTURE(a);
        CAPTURE(z);
        CAPTURE(s);
        const std::optional<Solution> found =
            convex::closed_form({Metric::dense(convex::Matrix{{1, a}, {a, 1}}),
                                 Vector{{z, a * z}},
                                 convex::ConstraintRows(convex::RowMatrix{{0, 1}}),
                                 Vector{{s}},
                                 {0}},
                                {});
        if (!found || found->status != Status::solved) continue;
        ++judged;
        const convex::DoubleDouble pull = convex::two_product(a, s);
        const double off1 = found->q[1] - s, off0 = ((found->q[0] - z) + pull.hi) + pull.lo;
        const double off = std::sqrt(std::max(0.0, off0 * off0 + 2 * a * off0 * off1 + off1 * off1));
        CHECK(off <= found->error_bound * (1 + 1e-12));
      }
  CHECK(judged >= 30);
}
