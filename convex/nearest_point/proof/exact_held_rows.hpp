#pragma once

#include <vector>

#include "convex/exact/integer_system.hpp"
#include "convex/nearest_point/proof/exact_problem.hpp"

namespace convex::inline proof {

/// The problem, which is referred to, with independent rows S held: its KKT system, which follows S, and its
/// point, q before the multipliers of S, all over one denominator.
class ExactHeldRows {
 public:
  ExactHeldRows(const ExactProblem& problem, const std::vector<Index>& rows)
      : problem_(problem), rows_(rows), system_(prepared()) {}

  ExactVector point() const;
  /// How the point moves with the multiplier of one more row, and with it the multipliers of S.
  ExactVector direction(const IntegerVector& row) const;

  /// Row p as the last one of S; S without its row k.
  void append(Index p);
  void remove(std::size_t k);

 private:
  IntegerSystem prepared() const;

  const ExactProblem& problem_;
  std::vector<Index> rows_;
  IntegerSystem system_;
};

}  // namespace convex::inline proof
