#pragma once

#include <span>
#include <vector>

#include "mechanics/motion/taylor_steps.hpp"

namespace mechanics {

/// The Taylor coefficients of the slots of a program along a motion, found order by order (Jorba and Zou
/// 2005): f(t + τ) = Σ c_k τ^k.
class TaylorSeries {
 public:
  using Slot = expression::Slot;

  /// Coefficients 0 to `order` of what `steps` computes.
  TaylorSeries(const TaylorSteps& steps, int order);

  int order() const { return order_; }
  std::span<double> operator[](Slot series) {
    return {c_.data() + series * width_, static_cast<std::size_t>(width_)};
  }
  std::span<const double> operator[](Slot series) const {
    return {c_.data() + series * width_, static_cast<std::size_t>(width_)};
  }
  /// The branch of each switch of the steps: 1 or -1.
  std::vector<double>& branches() { return branches_; }
  const std::vector<double>& branches() const { return branches_; }

  /// Coefficient k of all series of a group, those of the variables being known to order k.
  void advance(std::size_t group, int k);

  /// The highest coefficients of velocities enter coefficient k of the series of group 0 in a linear way:
  /// `change`, filled in for the velocities, is filled in for the series that depend on them.
  /// `lanes` changes at once, so many numbers a series.
  void carry(std::vector<double>& change, std::size_t lanes) const;
  /// Adds a change found by `carry` to coefficient k.
  void correct(int k, std::span<const double> change);
  std::size_t series() const { return steps_->series; }

 private:
  double* at(Slot series) { return c_.data() + series * width_; }
  const double* at(Slot series) const { return c_.data() + series * width_; }
  double branch(const TaylorStep& step) const { return branches_[static_cast<std::size_t>(step.number)]; }
  void begin(const TaylorStep& step);
  void extend(const TaylorStep& step, std::size_t k);

  const TaylorSteps* steps_;
  int order_;
  std::size_t width_;
  std::vector<double> c_;
  std::vector<double> branches_;
};

/// Σ c_k τ^k.
double value_at(std::span<const double> c, double tau);
/// Σ k c_k τ^(k-1).
double slope_at(std::span<const double> c, double tau);

}  // namespace mechanics
