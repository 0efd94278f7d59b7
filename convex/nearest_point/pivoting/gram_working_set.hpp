#pragma once

#include <optional>
#include <span>
#include <vector>

#include "convex/nearest_point/pivoting/gram_point.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::inline pivoting {

/// The rows of the working set and their whitened Gram matrix, in one representation or another: swept at the
/// working set
/// (`SweptRows`), or with a factor (`FactoredRows`). It finds the point of the rows of the working set and
/// corrects it; what that point says is decided by `GramSolve`. False is always: in doubt.
class GramWorkingSet {
 public:
  virtual ~GramWorkingSet() = default;

  virtual const NearestPointProblem& problem() const = 0;
  virtual GramPoint& point() = 0;
  /// Pivots from the rows guessed, or from those held after z and s have changed, until doubles find no row
  /// wrong; then the point in doubles.
  virtual bool settle(const std::vector<Index>& guess) = 0;
  virtual bool settle_again() = 0;
  /// The point in doubles of the working set, after z and s have changed, whatever its signs.
  virtual bool keep_working_set() = 0;
  /// Whether a multiplier (times its row's length) or a slack (over it) is no larger at the point settled on,
  /// as far as rows have been looked at; then `slack` is that of all.
  virtual bool is_near(double size) = 0;
  /// So many rows that near their edge it looks at.
  virtual Index most_near() const = 0;
  /// One correction of q and lambda with residuals in twice the working precision, in which rows that have
  /// been looked at change sides whose multipliers (times lengths) or slacks (over them) are `small`. False
  /// too when it does not settle.
  virtual bool correct(bool is_first, double small) = 0;
  /// `slack` of all rows and `magnitude`, in doubles; `stationarity`.
  virtual void measure() = 0;
  virtual void measure_balance() = 0;

  /// Looks at those of the rows that have not been looked at. False when there is no room.
  virtual bool look_at(std::span<const Index> rows) = 0;
  /// Whether rows that have been looked at each have more than this part, squared, outside the span of those
  /// held.
  virtual bool are_independent(std::span<const Index> rows, double part) = 0;
  /// Up to eight rows, side by side in `pack`, as if they were combinations of those held: the coefficients
  /// into `coefficients`, eight for each row of the working set. in_all: how many such rows are asked for.
  virtual void combine(std::span<const Index> rows, Index in_all) = 0;
  /// dq: a motion along the working set that raises the others given, as far as they are independent. Its
  /// ||·||_A; 0 where none is found.
  virtual double raise(std::span<const Index> rows) = 0;

  virtual std::vector<Index> one_sided_working_set() const = 0;
  /// Weights of rows that contradict each other, as doubles tell, where pivoting met such; they are to be
  /// proved.
  virtual std::optional<Vector> contradiction() const = 0;
};

}  // namespace convex::inline pivoting
