#pragma once

#include "convex/nearest_point/pivoting/gram_working_set.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"

namespace convex::inline pivoting {

/// Where coordinates are few: the Gram matrix of the whitened rows looked at is swept at the working set, so
/// that one pivot gives all multipliers and slacks (principal pivoting: Keller 1973; the sweep: Beaton 1964),
/// by the steps of the dual method (Goldfarb and Idnani 1983). Few rows are looked at all at once; of many
/// those that are violated, eight at a time: what has been looked at is settled before all are measured
/// again, so that the dual objective grows each time and this ends.
class SweptRows final : public GramWorkingSet {
 public:
  static bool fits(const NearestPointProblem& problem) {
    return problem.dimension() <= SmallTableau::most_coordinates;
  }

  /// The problem is referred to; its z and s may change from one solve to the next.
  SweptRows(const NearestPointProblem& problem, SmallTableau& tableau);

  /// Puts z, s and the rows to begin with into the tableau; the first half of `settle`.
  void begin(const std::vector<Index>& guess);

  const NearestPointProblem& problem() const override { return problem_; }
  GramPoint& point() override { return tableau_; }
  bool settle(const std::vector<Index>& guess) override;
  bool settle_again() override;
  bool keep_working_set() override;
  bool is_near(double size) override;
  Index most_near() const override { return looks_at_all() ? tableau_.all : few_near; }
  bool correct(bool is_first, double small) override;
  void measure() override;
  void measure_balance() override;
  bool look_at(std::span<const Index> rows) override;
  bool are_independent(std::span<const Index> rows, double part) override;
  void combine(std::span<const Index> rows, Index in_all) override;
  double raise(std::span<const Index>) override { return 0; }
  std::vector<Index> one_sided_working_set() const override;
  std::optional<Vector> contradiction() const override;

 private:
  static constexpr Index few_near = 16;

  void take_linear_term();
  bool take_in(const Index* rows, Index count);
  bool settle_all();
  Index fresh_violated_rows(Index* rows);
  bool looks_at_all() const { return tableau_.slack == tableau_.slack_at; }
  Index place(Index a) const { return looks_at_all() ? a : place_[a]; }
  void measure_slacks_of_all();
  void mark_weak(double small);
  void find_dual_rows();

  const NearestPointProblem& problem_;
  SmallTableau& tableau_;
  double *inverse_scale_ = nullptr,
         zeroed_ = 0,       ///< the multipliers of weak rows, times their lengths
      squares_ = 0;         ///< the sum of the squares of `row_scale`, where rows are many
  Index* place_ = nullptr;  ///< of a row, -1 for one not looked at; where rows are many
  Index sweeps_ = 0, dual_count_ = 0, dual_of_[SmallTableau::most_coordinates];  ///< rows that dual_ is of
  alignas(64) double dual_[SmallTableau::most_coordinates * SmallTableau::most_coordinates];
};

}  // namespace convex::inline pivoting
