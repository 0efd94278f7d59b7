#pragma once

#include <optional>

#include "convex/exact/integer_system.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/proof/exact_problem.hpp"

namespace convex::inline proof {

/// Rows with their bounds, over the coordinates that they touch.
struct RestrictedRows {
  RowMatrix U;
  Vector s;
};
RestrictedRows restricted_rows(const NearestPointProblem&, const std::vector<Index>& rows);
/// The same as integers, A left out.
ExactProblem as_integers(const RestrictedRows&);

/// Independent integer rows, with as many coordinates in which they are independent too.
class RowBasis {
 public:
  /// None when the rows depend on each other.
  static std::optional<RowBasis> of(const IntegerRows& rows, std::size_t dimension);
  const std::vector<std::size_t>& coordinates() const { return coordinates_; }
  /// c with u = Σ c_k u_k; none where u is no such sum.
  std::optional<ExactVector> coefficients(const IntegerVector& u) const;

 private:
  RowBasis(IntegerRows columns, std::vector<std::size_t> coordinates, IntegerSystem system)
      : columns_(std::move(columns)), coordinates_(std::move(coordinates)), system_(std::move(system)) {}

  IntegerRows columns_;  ///< of the rows
  std::vector<std::size_t> coordinates_;
  IntegerSystem system_;
};

/// Integers w without a common factor, w_0 > 0, with Σ w_a U_a / row_unit_a = 0 over all rows; empty when
/// those but the first depend on each other, or the first does not on them.
IntegerVector dependence_of(const ExactProblem& exact);

/// Whether rows a and `others`, each of them needed, add up to 0 with positive weights (of any sign on
/// two-sided rows), and their bounds too: then each holds with equality wherever all are satisfied. In
/// integers.
bool are_equalities(const NearestPointProblem&, Index a, const std::vector<Index>& others);

/// Whether the equations u_r·q = s_r of the rows `held`, which are independent, imply those of other rows
/// (u_a·q >= s_a when they are one-sided): each u_a is exactly a combination of those held, and s_a (at most)
/// that of their bounds. By one integer system for all. False, too, when that takes more than so many word
/// operations.
bool follow_exactly(const NearestPointProblem&, const std::vector<Index>& rows,
                    const std::vector<Index>& held, double most_words);

/// Whether u_p = Σ T(k, p) u_k, over the rows `basic`, are the dependences of the rows as they stand, up to
/// the digits of T: modulo a prime, which may err to yes, entries are 0 where those of T are, and nothing is
/// left. None when that takes more than so many word operations.
std::optional<bool> depend_as_told(const NearestPointProblem&, const std::vector<Index>& basic,
                                   const std::vector<Index>& dependent, const Matrix& T, double most_words);

}  // namespace convex::inline proof
