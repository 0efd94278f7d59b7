#pragma once

#include <span>
#include <vector>

#include "mechanics/motion/taylor_recurrence.hpp"

namespace mechanics::inline motions {

/// The Taylor coefficients of the slots of a program along a motion, found order by order (Jorba and Zou
/// 2005): f(t + τ) = Σ c_k τ^k.
///
/// An order has two stages: what the lower orders and the coordinates make of it, and what velocities add.
/// The factors of products are kept by product (`TaylorProducts`). The rows of an order are gone through one
/// after the other, or, where there are few series, are one matrix (`TaylorRecurrence`).
class TaylorSeries {
 public:
  using Slot = expression::Slot;

  /// Coefficients 0 to `order` of what `of` asks for; it must outlive them.
  TaylorSeries(const TaylorProgram& of, int order);

  int order() const { return order_; }
  /// Of what is not asked for with all coefficients, the first one is known.
  std::span<const double> operator[](Slot series) const {
    const std::size_t known = place_[series] < place_[0] ? 1 : static_cast<std::size_t>(order_) + 1;
    return {at(series), known};
  }
  /// Coefficient 0 of a variable, which `begin` starts from.
  double& start(Slot variable) { return at(variable)[0]; }
  /// The coefficient of the order looked for.
  double& at_order(Slot series) { return now_[series]; }
  double at_order(Slot series) const { return now_[series]; }
  /// The branch of each switch of the steps: 1 or -1, or 0 where its argument stays 0.
  std::vector<double>& branches() { return branches_; }
  const std::vector<double>& branches() const { return branches_; }
  /// Series of which a root or a power is taken, and whose coefficient 0 counts as 0.
  std::vector<Slot>& bases_at_zero() { return bases_at_zero_; }

  /// Coefficient 0 of all series of a group, and their partial derivatives.
  void begin(std::size_t group);
  /// The former alone.
  void find_values(std::size_t group);
  /// Forgets the orders above 0.
  void restart();
  /// Of order k >= 1, from the coefficients of the coordinates and of time: what was asked for as if those of
  /// the velocities, which are set to 0, were 0.
  void find_at_rest(int k);
  /// All of order k, from those of the velocities too.
  void find(int k);
  /// All orders of a motion without contacts, from those of order 0, A and the force on each coordinate: of
  /// the coordinates, and of what is asked for with all coefficients. False, and nothing is known, where that
  /// does not pay or a number is not finite.
  bool find_free(const InertiaFactor& A, std::span<const double> force);
  /// The highest order at which a series that products or askers read has had a coefficient that is not 0.
  int degree() const { return degree_; }
  /// From this order on the series that are kept, but for variables, are 0.
  int found() const { return found_; }
  /// The last coefficient of a variable, which nothing depends on any more.
  void end(Slot variable, int k, double coefficient) { at(variable)[k] = coefficient; }
  /// From its first coefficient on that is not finite a series counts as 0.
  void cut();
  /// The least order at which a power of what is 0 at the state, but does not stay so, has a derivative that
  /// is not finite; its derivatives count as 0. 0 where there is none.
  int without_bound() const { return without_bound_; }

  /// So many of its coefficients, from the first one on, do not hang on such derivatives.
  int known(Slot series) const { return known_.empty() ? order_ + 1 : known_[series]; }

  /// The recurrences, and their terms with the partial derivatives at order 0.
  const TaylorRows& rows() const { return rows_; }
  const std::vector<TaylorRows::Term>& terms() const { return terms_; }
  std::size_t series() const { return rows_.series; }
  /// How many operations lead to a coefficient of order 0 at most.
  std::size_t operations() const { return steps_->steps.size(); }

 private:
  friend class TaylorMagnitude;
  double* at(Slot series) { return c_.data() + place_[series]; }
  const double* at(Slot series) const { return c_.data() + place_[series]; }
  double branch(const TaylorStep& step) const { return branches_[static_cast<std::size_t>(step.number)]; }
  double value(const TaylorStep& step);
  double base(const TaylorStep& step) const;
  bool stays_zero(const TaylorStep& step) const;
  int known(const TaylorStep& step) const;
  void differentiate_at_zero(const TaylorStep& step, double exponent, double& by, double& factor);
  void differentiate(const TaylorStep& step, std::uint32_t row);
  double of_row(std::size_t row) const;
  bool order_is_zero(int k) const;

  const TaylorSteps* steps_;
  const TaylorRows& rows_;
  std::vector<TaylorRows::Term> terms_;  // with the coefficients at a state
  int order_;
  std::size_t groups_;  // with orders above 0
  TaylorProducts products_;
  const std::vector<Slot>& kept_;  // with all coefficients, but for variables
  TaylorRecurrence free_;
  std::size_t width_;
  std::vector<std::size_t> place_;  // of series in c_
  std::vector<double> c_;
  std::vector<double> factor_;  // ρ, by row
  std::vector<double> now_;     // of the order looked for, by series
  std::vector<double> branches_;
  std::vector<Slot> bases_at_zero_;
  std::vector<bool>
      stays_zero_;          // by series, on the branches taken; empty where no root or power asks for it
  std::vector<int> known_;  // likewise
  std::vector<double> velocity_;
  int degree_ = 0, found_ = 0, without_bound_ = 0;
};

/// Σ c_k τ^k.
double value_at(std::span<const double> c, double tau);
/// Σ k c_k τ^(k-1).
double slope_at(std::span<const double> c, double tau);

}  // namespace mechanics::inline motions
