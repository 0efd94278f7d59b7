#pragma once

#include <vector>

#include "convex/nearest_point/multipliers/multipliers.hpp"

namespace convex::inline multiplier_sets {

/// The polyhedron of multipliers at one of its vertices, as a simplex tableau: the basic multipliers are
/// value - T (nonbasic ones). Multipliers of two-sided rows are free; the others are >= 0.
class MultiplierTableau {
 public:
  /// basic: names of the basic multipliers with their values (>= 0 where not free); nonbasic: those at 0; T:
  /// one row a basic one, one column a nonbasic one; is_free: by name.
  MultiplierTableau(std::vector<Index> basic, Vector value, std::vector<Index> nonbasic, Matrix T,
                    const std::vector<bool>& is_free);

  /// The interval of the multiplier named `a` over the polyhedron; not a number where rounding keeps the
  /// pivots from an end.
  Interval range(Index a);

 private:
  /// What pivots change.
  struct State {
    std::vector<Index> basic, nonbasic;
    Vector value;
    Matrix T;
  };

  double extreme(Index a, double direction);
  /// A column whose growth moves the basic multiplier of `row` that way: the steepest or the least by name;
  /// or -1.
  Index entering_column(Index row, double direction, bool by_name) const;
  /// The row that blocks the increase of nonbasic column `column`, or -1; `step` is how far it may go.
  Index blocking_row(Index column, double sign, double& step) const;
  void pivot(Index row, Index column);
  void settle_free_columns();
  bool is_free(Index name) const { return free_[static_cast<std::size_t>(name)]; }

  std::vector<Index> basic_, nonbasic_;
  Vector value_;
  Matrix T_;
  std::vector<bool> free_, unbounded_, fixed_;
  double noise_, value_noise_;
  State start_;
  Index pivots_ = 0;  // since the tableau was as at the start
};

}  // namespace convex::inline multiplier_sets
