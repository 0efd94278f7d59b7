#pragma once

#include "mechanics/motion/taylor_steps.hpp"

namespace mechanics::inline motions {

/// The recurrences of `TaylorSteps` beyond order 0. Coefficient k of each is linear in those of the same
/// order, with the partial derivatives at order 0, and has a rest from lower orders:
///   out_k = Σ c_i a_(i,k) + ρ Σ_p s_p R_(p,k),     R_(p,k) = Σ_(j=1)^(k-1) x_j y_(k-j),
/// over its products p; for a step with a differential equation R_(p,k) = Σ_(j=1)^(k-1) j x_j y_(k-j) / k.
/// Sums, differences and multiples that nothing but another row needs are part of that row.
struct TaylorRows {
  using Slot = expression::Slot;
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  struct Term {
    Slot series;
    double c;  ///< of a step that is not linear: from order 0 on
  };
  struct Row {
    Slot out;
    std::uint32_t first, end;                  ///< its terms
    std::uint32_t first_product, end_product;  ///< its p
  };
  struct Product {
    Slot x, y;
    double scale;      ///< s
    bool is_weighted;  ///< with the factor j / k
  };
  /// Where a group ends in the lists.
  struct Ends {
    std::size_t rows = 0, products = 0;
  };
  /// What is asked for.
  struct Asked {
    std::vector<Slot> series;    ///< with all coefficients
    std::vector<Slot> of_order;  ///< while an order is looked for
    std::vector<Slot> at_rest;   ///< of group 0: the same, as if the velocities of that order were 0
  };

  TaylorRows(const TaylorSteps& steps, const Asked& asked);

  std::vector<Row> rows;
  std::vector<Term> terms;
  std::vector<Product> products;
  std::vector<Ends> ends;                     ///< by group
  std::vector<std::uint32_t> row_of_step;     ///< the first row of a step; none where it has none
  std::vector<std::uint32_t> by_velocity;     ///< rows of group 0 that depend on velocities
  std::vector<std::uint32_t> after_velocity;  ///< those of them that are read once velocities are known
  std::size_t series = 0;
  Slot zero = 0;  ///< a series that is 0
};

}  // namespace mechanics::inline motions
