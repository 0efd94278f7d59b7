#pragma once

#include <optional>
#include <vector>

#include "convex/constraint_rows.hpp"

namespace convex::inline sparse {

/// Which of some rows depend on others, and whether their bounds agree with that: for rows `held`, whose
/// equations u_a·q = s_a hold, and rows `degenerate` besides.
struct RowDependences {
  std::vector<Index>
      independent;  ///< a basis of all of them, of rows of the working set where that can be; increasing
  std::vector<Index>
      implied;  ///< degenerate rows whose slack is 0 wherever the rows of the working set hold; increasing
  bool consistent = true;  ///< the equations of the rows of the working set do not contradict each other
  /// Degenerate rows that depend on those held and have another slack, the same wherever these hold;
  /// increasing.
  std::vector<Index> off_edge;
  bool operator==(const RowDependences&) const = default;
};

/// Elimination of the doubles as they stand, row by row in an order of the coordinates that keeps rows short
/// (George and Heath 1980), modulo a prime p near 2^62: rows independent there are so over the rationals,
/// which is a proof. A number that is 0 there is 0 unless p divides it: where some are, a second prime has to
/// find the same ones. For residues that are distributed evenly both miss one of N numbers with a probability
/// of N 2⁻¹²⁴, below 1e-29 for a hundred million. None when the primes differ, or when one takes more
/// multiplications than `most`.
std::optional<RowDependences> row_dependences(const ConstraintRows& U, const Vector& s,
                                              const std::vector<Index>& held,
                                              const std::vector<Index>& degenerate, double most);

}  // namespace convex::inline sparse
