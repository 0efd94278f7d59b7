#pragma once

#include <optional>

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

/// Integers w without a common factor, w_a > 0 for one of them, with Σ w_a U_a = 0 in as many columns as the
/// rows are independent in; empty when there is more than one such w up to a factor.
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
