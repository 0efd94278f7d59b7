#pragma once

#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/nearest_point/pivoting/gram_working_set.hpp"

namespace convex::inline pivoting {

/// The rows of the working set with a factor of their Gram matrix: `GramPivoting` finds them.
class FactoredRows final : public GramWorkingSet {
 public:
  /// The problem is referred to; its z and s may change from one solve to the next.
  FactoredRows(const NearestPointProblem& problem, Arena& arena);

  const NearestPointProblem& problem() const override { return problem_; }
  GramPoint& point() override { return p_; }
  bool settle(const std::vector<Index>& guess) override;
  bool settle_again() override;
  bool keep_working_set() override;
  bool is_near(double size) override;
  Index most_near() const override { return p_.all; }
  bool correct(bool is_first, double small) override;
  void measure() override;
  void measure_balance() override;
  bool look_at(std::span<const Index> rows) override;
  bool are_independent(std::span<const Index> rows, double part) override;
  void combine(std::span<const Index> rows, Index in_all) override;
  double raise(std::span<const Index> rows) override;
  std::vector<Index> one_sided_working_set() const override { return set_->one_sided_working_set(); }
  std::optional<Vector> contradiction() const override { return set_->contradiction(); }

 private:
  void whiten_z();
  void take_point(bool has_changed);
  void list_working_set(bool have_changed);
  double take_weak_for_zero(double small);
  void find_residual(bool is_first);
  void rest_loads(bool is_first, bool with_outside);
  void find_dual_rows();
  void solve_dual_rows();

  const NearestPointProblem& problem_;
  const DenseKernels& kernels_;
  const DenseFactor A_;
  GramPoint p_;
  std::optional<GramPivoting> set_;
  double *load_, *y_, *rest_;  // y_, rest_: at places, y_ the last change of the multipliers
  double* dual_;
  Index *fresh_, *dual_of_;  // dual_of_: the rows that dual_ is of, dual_count_
  Index dual_count_ = 0;
  bool are_solved_ = false;
};

}  // namespace convex::inline pivoting
