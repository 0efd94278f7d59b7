#pragma once

#include <optional>

#include "convex/exact/integer.hpp"

/// Exact linear algebra over integer rows, without fractions (Bareiss 1968; Edmonds 1967).
namespace convex::inline exact_arithmetic {

/// Σ a_i b_i.
Integer dot(const IntegerVector& a, const IntegerVector& b);

/// The reduced row echelon form of a linear space: its rows are primitive, positive at their own pivot and 0
/// at the pivots of the others; pivots increase. It depends on the space alone, not on the rows that span it.
struct Echelon {
  std::size_t columns = 0;
  IntegerRows rows;
  std::vector<std::size_t> pivots;
  std::size_t rank() const { return rows.size(); }
};

Echelon echelon(const IntegerRows& rows, std::size_t columns);

/// A positive multiple of v plus rows of the space that is 0 at its pivots, primitive: 0 when v lies in the
/// space.
IntegerVector reduced(IntegerVector v, const Echelon& space);

/// Takes v into the space; whether that made it larger.
bool extend(Echelon& space, const IntegerVector& v);

/// {a : a·v = 0 for all v in the space}.
Echelon annihilator(const Echelon& space);

/// The primitive a with a·v = 0 for r - 1 independent rows v of r entries each (up to its sign), r >= 1;
/// empty when the rows are dependent.
IntegerVector common_normal(const std::vector<const IntegerVector*>& rows, std::size_t r);

/// A⁻¹ = adjugate / determinant.
struct ExactInverse {
  IntegerRows adjugate;
  Integer determinant;
};

/// The inverse of a symmetric matrix when it is positive definite (all leading minors are positive), else
/// none.
std::optional<ExactInverse> positive_definite_inverse(const IntegerRows& A);

/// One exchange of a basis by integer pivoting. `adjugate` / determinant is the inverse of the matrix whose
/// rows are the basis; row k is replaced by a vector with coefficients c / determinant in the old basis, c_k
/// not 0. The determinant is kept positive.
void exchange(ExactInverse& inverse, std::size_t k, const IntegerVector& c);

/// v A for the rows of A.
IntegerVector times(const IntegerVector& v, const IntegerRows& A);

}  // namespace convex::inline exact_arithmetic
