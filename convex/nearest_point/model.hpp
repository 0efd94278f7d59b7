#pragma once

#include <string_view>
#include <vector>

#include "convex/vector.hpp"

namespace convex {

/// Coordinates and rows that were solved together, apart from all others.
struct Island {
  std::string_view method;
  Index coordinates = 0, rows = 0;
  Index first_coordinate = 0;  ///< the least of its coordinates, which names it
  double flops = 0;            ///< an estimate, the same for the same data
  double factor_nonzeros = 0;  ///< numbers in the factors kept
  std::string_view in_fractions =
      {};  ///< what doubles left open and fractions decided; empty where doubles did all
};

/// Why a row took no part in a solve; each is proved before it is used.
/// no_gradient: u_a = 0 and s_a <= 0. free_motion_keeps: q = A⁻¹z satisfies all rows of the island, so it is
/// the answer. out_of_reach: 0 is admissible, so that the answer lies in the ball that has 0 and A⁻¹z as ends
/// of a diameter, and the row leaves this ball free.
enum class LeftOutBecause { no_gradient, free_motion_keeps, out_of_reach };

struct LeftOutRow {
  Index row = 0;
  LeftOutBecause why = LeftOutBecause::no_gradient;
};

/// What was solved in the end: the islands, by their first coordinate, and the rows that took no part, in
/// order.
struct Model {
  std::vector<Island> islands;
  std::vector<LeftOutRow> left_out;
  double flops() const {
    double sum = 0;
    for (const Island& island : islands) sum += island.flops;
    return sum;
  }
};

}  // namespace convex
