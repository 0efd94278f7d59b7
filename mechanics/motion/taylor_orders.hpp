#pragma once

#include <cstddef>

#include "mechanics/motion/eight.hpp"

namespace mechanics::inline motions {

/// Places among the numbers of an order.
struct alignas(64) Places {
  long long of[Eight::count] = {};
};

/// What the orders of a `TaylorRecurrence` are made of, in blocks of eight: the numbers of an order are a
/// matrix times its inputs, v_(k-1) / k, F_(k-1) / k and the rests of products, whose factors are among the
/// numbers.
struct TaylorOrders {
  std::size_t products, moving;  ///< columns of each kind
  std::size_t product_blocks, moving_blocks, blocks, count;
  const double *of_rests, *of_moving, *of_time;
  const Places *place_of_x, *place_of_y;
  const double* weighted;             ///< 1 for products with the factor j / k, else 0
  const double *part, *rest_of_part;  ///< 1 / k and its rounding error, by order
  double *input, *numbers, *x, *y;

  /// Factors stand by block and order; so many zeros are there before the first order and after the last.
  static constexpr std::size_t zeros = 5;
  std::size_t width() const { return count + 2 * zeros; }
  static constexpr std::size_t most_blocks = 64;
};

}  // namespace mechanics::inline motions
