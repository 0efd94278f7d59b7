#include <doctest/doctest.h>

#include <cmath>

#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Value;
using convex::Vector;

TEST_CASE(
    "a translation that a far point rounds away is in the value by a slope that is known, or is its error") {
  for (const double v : {1e9, 1e14, 1e17, 1e20, 1e22}) {
    const Value value =
        samples::function(
            "sum(squared_norm2(), log_sum_exp(), exponential(), total_variation(3), linear([3]))", 1)
            .conjugate()
            .evaluate(Vector{{v}});
    const double x = std::log(v);
    CAPTURE(v);
    CHECK(std::abs(value.value - (v * (x - 1) - 4 * x - x * x / 2)) <= value.error + 1e-15 * v * x);
  }
}
