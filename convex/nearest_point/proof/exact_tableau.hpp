#pragma once

#include <vector>

#include "convex/nearest_point/proof/exact_multipliers.hpp"

namespace convex::inline proof {

/// The polyhedron of multipliers at one of its vertices, as a simplex tableau in fractions: the basic
/// multipliers are value - T (nonbasic ones). Multipliers of two-sided rows are free; the others are >= 0.
/// Bland's rule (1977), so finite.
class ExactTableau {
 public:
  /// basic: names of the basic multipliers with their values (>= 0 where not free); nonbasic: those at 0; T:
  /// one row a basic one, one column a nonbasic one; is_free: by name.
  ExactTableau(std::vector<Index> basic, std::vector<Fraction> value, std::vector<Index> nonbasic,
               std::vector<std::vector<Fraction>> T, std::vector<bool> is_free);

  /// The interval of the multiplier named `a` over the polyhedron.
  ExactInterval range(Index a);

 private:
  std::optional<Fraction> highest(Index a);
  std::optional<Fraction> lowest(Index a);
  /// The basic row other than `except` that blocks nonbasic column j when it grows (side 1) or shrinks, or
  /// -1.
  std::ptrdiff_t blocking(std::size_t j, int side, std::ptrdiff_t except) const;
  void pivot(std::size_t k, std::size_t j);
  void settle_free_columns();
  std::ptrdiff_t basic_row(Index a) const;
  bool is_free(Index name) const { return free_[static_cast<std::size_t>(name)]; }

  std::vector<Index> basic_, nonbasic_;
  std::vector<Fraction> value_;
  std::vector<std::vector<Fraction>> T_;
  std::vector<bool> free_, unbounded_;
};

}  // namespace convex::inline proof
