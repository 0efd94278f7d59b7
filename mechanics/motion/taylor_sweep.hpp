#pragma once

#include "mechanics/motion/taylor_kernels.hpp"
#include "mechanics/motion/taylor_rows.hpp"

namespace mechanics::inline motions {

/// The matrix of an order: by how much the series that are asked for change with each variable and with each
/// rest of a product. A sweep over the rows backwards, of which only what can differ from 0 is carried out.
class TaylorSweep {
 public:
  using Slot = expression::Slot;

  TaylorSweep() = default;
  /// asked: a series, and its place among the numbers of a column, of so many blocks of eight.
  TaylorSweep(const TaylorRows& rows, std::size_t count, std::size_t variables, std::size_t products,
              const std::vector<std::pair<Slot, std::size_t>>& asked, std::size_t blocks);

  /// How many coefficients there are, and how many blocks. The columns are the first of them: those of the
  /// variables, then those of the rests.
  std::size_t coefficients() const { return terms_ + row_of_product_.size(); }
  std::size_t size() const { return asked_.size(); }
  /// From the coefficients of the rows and their factors at a state; c and x: memory.
  void find(const TaylorRows& rows, const TaylorRows::Term* terms, const double* factor,
            std::vector<double>& c, Eight* x) const;

 private:
  std::size_t terms_ = 0;
  std::vector<SweepSum> sums_;
  std::vector<SweepPart> parts_;
  std::vector<std::uint32_t> row_of_product_;
  std::vector<Eight> asked_;
};

}  // namespace mechanics::inline motions
