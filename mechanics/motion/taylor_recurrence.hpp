#pragma once

#include "mechanics/motion/inertia_factor.hpp"
#include "mechanics/motion/taylor_products.hpp"

namespace mechanics::inline motions {

/// All orders of a free motion of few coordinates in one pass. With no contact held, every number of order k
/// is linear in the rests of that order and in v_(k-1) / k and F_(k-1) / k: the rows of an order and A⁻¹ are
/// one matrix, found once a step by a sweep over the rows backwards, and no number of an order has to wait
/// for another of the same order.
class TaylorRecurrence {
 public:
  using Slot = expression::Slot;

  /// What the equations A v_k = F_(k-1) / k - p_k are made of, by coordinate, and the series that are kept.
  struct Equations {
    std::vector<Slot> momentum;
    std::vector<std::pair<Index, Slot>> force;
    std::vector<Slot> kept;
  };

  TaylorRecurrence(const TaylorSteps& steps, const TaylorRows& rows, std::size_t groups, Equations equations,
                   int order);

  /// Whether this is quicker than the rows one after the other.
  bool pays() const { return blocks_ > 0; }
  /// From the coefficients of the rows and their factors at a state, A, and v and F of order 0. False, where
  /// a number found is not finite.
  bool find(const TaylorRows& rows, const std::vector<double>& factor, const InertiaFactor& A,
            const double* v, const double* F);
  /// The coefficients after `find`, of orders below `end` <= `order`; all others are 0.
  int end() const { return static_cast<int>(end_); }
  double velocity(Index i, int k) const { return number(static_cast<std::size_t>(i), k); }
  double kept(std::size_t which, int k) const { return number(first_kept_ + which, k); }

 private:
  double number(std::size_t at, int k) const {
    return numbers_[static_cast<std::size_t>(k) * number_blocks_ + at / Eight::count].of[at % Eight::count];
  }
  void sweep(const TaylorRows& rows, const std::vector<double>& factor);
  void fold(Eight* column);
  bool run();

  Equations equations_;
  std::size_t coordinates_, variables_, rows_, products_, orders_;
  std::size_t end_ = 0, product_blocks_ = 0, number_blocks_ = 0, blocks_ = 0, first_kept_ = 0;
  std::vector<std::pair<Slot, std::size_t>> places_;  // of series among the numbers and factors
  std::vector<Eight> by_series_;                      // a row of blocks each; first the variables: q, v, t
  std::vector<Eight> of_moving_;                      // columns of v_(k-1) / k and of F_(k-1) / k
  std::vector<Eight> of_rests_;                       // columns
  std::vector<Eight> numbers_;                        // v, F and what is kept, by order
  std::vector<Eight> x_, y_, weighted_;               // factors by block and order; 1 for the factor j / k
  std::vector<Eight> input_;                          // v_(k-1) / k, F_(k-1) / k; the rests
  std::vector<double> part_, rest_of_part_;           // 1 / k and its rounding error
  std::vector<Eight> share_, rest_of_share_;  // the same for products with the factor j / k; else 1, 0
  Vector change_;
};

}  // namespace mechanics::inline motions
