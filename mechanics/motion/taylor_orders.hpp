#pragma once

#include "mechanics/motion/eight.hpp"

namespace mechanics::inline motions {

/// Places among the numbers of an order.
using Places [[gnu::vector_size(sizeof(Eight)), gnu::may_alias]] = long long;

/// What the orders of a `TaylorRecurrence` are made of, in blocks of eight: the numbers of an order are a
/// matrix times its inputs, v_(k-1) / k, F_(k-1) / k and the rests of products, whose factors are among the
/// numbers.
struct TaylorOrders {
  std::size_t products, moving;  ///< columns of each kind
  std::size_t product_blocks, moving_blocks, blocks, count;
  const Wide *of_rests, *of_moving, *of_time;
  const Places *place_of_x, *place_of_y;
  const Wide* weighted;               ///< 1 for products with the factor j / k, else 0
  const double *part, *rest_of_part;  ///< 1 / k and its rounding error, by order
  Wide *input, *numbers, *x, *y;

  /// Factors stand by block and order; so many zeros are there before the first order and after the last.
  static constexpr std::size_t zeros = 5;
  std::size_t width() const { return count + zeros; }
};

/// Orders 1 to count - 1, from that of 0. Returns the first one from which on all are 0.
std::size_t find_orders(const TaylorOrders& of, bool& all_finite);

}  // namespace mechanics::inline motions
