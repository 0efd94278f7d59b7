#pragma once

#include <vector>

#include "mechanics/motion/lagrange_equations.hpp"
#include "mechanics/motion/taylor_series.hpp"

namespace mechanics::inline motions {

/// The entries of A = ∂p/∂q', by the rows that depend on velocities: the highest coefficients of velocities
/// enter the others of their order in a linear way. Columns of A without a row in common are found as one, so
/// that a diagonal A takes one sweep however many coordinates there are (Curtis, Powell and Reid 1974).
class InertiaColumns {
 public:
  /// An entry that need not be 0.
  struct Entry {
    convex::Index row, column;
    double value;
  };

  /// Both must outlive it.
  InertiaColumns(const LagrangeEquations& equations, const TaylorSeries& series)
      : equations_(equations), series_(series) {}

  /// From the partial derivatives at the state that the series have begun at; false where these are as they
  /// were.
  bool find();
  /// By rows.
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  struct Term {
    expression::Slot series;
    std::uint32_t number;  // among those of the series
  };
  struct Row {
    expression::Slot out;
    std::size_t end;  // of its terms
  };

  void find_structure();
  void colour(const std::vector<std::vector<std::uint32_t>>& columns_of_row);
  void sweep(std::size_t first, std::size_t lanes);

  const LagrangeEquations& equations_;
  const TaylorSeries& series_;
  bool is_begun_ = false;
  std::vector<double> branches_;  // that the structure belongs to
  std::vector<Row> rows_;
  std::vector<Term> terms_;
  std::vector<double> partials_;     // by term
  std::vector<std::size_t> colour_;  // by column
  std::size_t colours_ = 0;
  std::vector<double> change_;  // by series and lane
  std::vector<Entry> entries_;
};

}  // namespace mechanics::inline motions
