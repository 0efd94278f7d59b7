#pragma once

#include <vector>

#include "mechanics/motion/eight.hpp"
#include "mechanics/motion/taylor_rows.hpp"

namespace mechanics::inline motions {

/// The rests R_(p,k) of products from the lower coefficients of their factors. Eight products stand side by
/// side, order by order, so that one pass over contiguous numbers finds an order of all eight, and no sum
/// goes across.
class TaylorProducts {
 public:
  TaylorProducts(std::span<const TaylorRows::Product> products, int order);

  std::size_t blocks() const { return rest_.size(); }
  /// R_(p,k), by product.
  const double* rest() const { return rest_.data()->of; }
  /// Finds R_(p,k) of all products, k >= 1.
  void find(int k);
  /// Coefficient k of the factors, from those of all series.
  void take(const double* of_series, int k);
  /// Whether every R of the last order found is 0.
  bool are_zero() const;

 private:
  std::span<const TaylorRows::Product> products_;
  std::size_t width_;
  std::vector<Eight> x_, y_;     // by block and order
  std::vector<Eight> weighted_;  // by block: 1 for the factor j / k, else 0
  std::vector<Eight> rest_;      // by block
};

}  // namespace mechanics::inline motions
