#pragma once

#include <utility>

#include "mechanics/motion/taylor_orders.hpp"
#include "mechanics/motion/taylor_sweep.hpp"

namespace mechanics::inline motions {

/// What makes an order of a free motion one matrix, as far as the expressions alone tell: which series are
/// its numbers, where the factors of products are among them, and the sweep that finds the columns.
struct TaylorMatrix {
  using Slot = expression::Slot;

  /// What the equations A v_k = F_(k-1) / k - p_k are made of, by coordinate, and the series that are kept.
  struct Equations {
    std::vector<Slot> momentum;
    std::vector<std::pair<Index, Slot>> force;
    std::vector<Slot> kept;
  };

  TaylorMatrix(const TaylorSteps& steps, const TaylorRows& rows, const Equations& equations);

  /// Whether this is quicker than the rows one after the other.
  bool pays() const { return blocks > 0; }

  std::size_t coordinates, variables, row_count, products;
  std::size_t blocks = 0;                      ///< of the numbers; 0: none are found
  std::vector<std::size_t> kept_at;            ///< places among the numbers
  std::vector<Places> place_of_x, place_of_y;  ///< of factors among them
  std::vector<Eight> weighted;                 ///< 1 for products with the factor j / k
  TaylorSweep sweep;
};

/// How many groups of a program have series beyond order 0.
std::size_t groups_with_orders(const TaylorSteps& steps);

/// All that a program tells of its series, found once.
struct TaylorProgram {
  TaylorProgram(TaylorSteps of, const TaylorRows::Asked& asked, const std::vector<expression::Slot>& momentum,
                const std::vector<std::pair<Index, expression::Slot>>& force);

  TaylorSteps steps;
  TaylorRows rows;
  std::vector<expression::Slot> kept;  ///< series with all coefficients
  TaylorMatrix matrix;
};

}  // namespace mechanics::inline motions
