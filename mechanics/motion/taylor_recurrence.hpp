#pragma once

#include "mechanics/motion/inertia_factor.hpp"
#include "mechanics/motion/taylor_matrix.hpp"
#include "mechanics/motion/taylor_products.hpp"

namespace mechanics::inline motions {

/// All orders of a free motion of few coordinates in one pass. With no contact held, every number of order k
/// is linear in the rests of that order and in v_(k-1) / k and F_(k-1) / k: the rows of an order and A⁻¹ are
/// one matrix, found once a step by a sweep over the rows backwards, and no number of an order has to wait
/// for another of the same order.
class TaylorRecurrence {
 public:
  /// `plan` must outlive it.
  TaylorRecurrence(const TaylorMatrix& plan, int order);
  TaylorRecurrence(const TaylorRecurrence&) = delete;
  TaylorRecurrence& operator=(const TaylorRecurrence&) = delete;

  bool pays() const { return plan_->pays(); }
  /// From the coefficients of the rows and their factors at a state, A, and v and F of order 0. False, where
  /// a number found is not finite.
  bool find(const TaylorRows& rows, const TaylorRows::Term* terms, const double* factor,
            const InertiaFactor& A, const double* v, const double* F);
  /// The coefficients after `find`, of orders below `end` <= `order`; all others are 0.
  int end() const { return static_cast<int>(end_); }
  /// Coefficients 1 to `end` of a coordinate, v_(k-1) / k.
  void positions(std::size_t i, double* q) const;
  double velocity(Index i, int k) const { return number(static_cast<std::size_t>(i), k); }
  double kept(std::size_t which, int k) const { return number(plan_->kept_at[which], k); }

 private:
  double number(std::size_t at, int k) const {
    return numbers_[static_cast<std::size_t>(k) * plan_->blocks + at / Eight::count].of[at % Eight::count];
  }
  bool run();

  const TaylorMatrix* plan_;
  std::size_t orders_, end_ = 0;
  std::vector<double> c_;              // what the sweep multiplies by
  std::vector<Eight> changes_;         // v by a unit of each input, by coordinate
  std::vector<Eight> memory_;          // of what follows
  Eight* columns_ = nullptr;           // of v_(k-1) / k, F_(k-1) / k, of time and of rests
  Eight* by_velocity_ = nullptr;       // columns, before v is known
  Eight* numbers_ = nullptr;           // by order
  Eight *x_ = nullptr, *y_ = nullptr;  // factors by block and order
  Eight* input_ = nullptr;             // v_(k-1) / k, F_(k-1) / k; the rests
};

}  // namespace mechanics::inline motions
