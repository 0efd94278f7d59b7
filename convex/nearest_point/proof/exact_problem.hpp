#pragma once

#include <vector>

#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::inline proof {

/// The nearest-point problem over the rationals, as integers: its metric is A / unit, its linear term z /
/// unit, its row a U_a / row_unit_a with the bound s_a / row_unit_a; units are positive. Multipliers of the
/// integer rows, lambda^, stand for lambda_a = lambda^_a row_unit_a / unit.
struct ExactProblem {
  IntegerRows A;
  IntegerVector z;
  Integer unit = 1;
  IntegerRows U;
  IntegerVector s;
  IntegerVector row_unit;
  std::vector<Index> two_sided;

  Index dimension() const { return static_cast<Index>(z.size()); }
  Index rows() const { return static_cast<Index>(s.size()); }
};

/// The problem with its doubles at their exact values. Throws InvalidInput when A is not positive definite as
/// it stands (doubles may have rounded what is).
ExactProblem exact_problem(const NearestPointProblem&);

/// The problem from fractions: A: n rows, z: n, U: m rows of n entries, s: m. Entries of A that mirror each
/// other may differ by rounding, as in Metric::dense; their mean is then meant. Throws InvalidInput when A is
/// not symmetric positive definite.
ExactProblem exact_problem(const ExactRows& A, const ExactVector& z, const ExactRows& U, const ExactVector& s,
                           std::vector<Index> two_sided);

/// The same of an A known to be positive definite, as Tᵀ T + 1 is.
ExactProblem exact_problem_of_definite(const ExactRows& A, const ExactVector& z, const ExactRows& U,
                                       const ExactVector& s, std::vector<Index> two_sided);

/// One more row with its bound, doubles at their exact values.
void append_row(ExactProblem&, const Vector& row, double s);

/// The doubles nearest to the problem's numbers.
NearestPointProblem rounded(const ExactProblem&);

/// A q - z - Σ lambda_a u_a times `unit`, over one denominator: n. lambda: m.
ExactVector reaction(const ExactProblem&, const ExactVector& lambda);

/// ||x||_A² .
Fraction squared_norm(const ExactProblem&, const ExactVector& x);
/// ||x - y||_A².
Fraction squared_distance(const ExactProblem&, const ExactVector& x, const ExactVector& y);

}  // namespace convex::inline proof
