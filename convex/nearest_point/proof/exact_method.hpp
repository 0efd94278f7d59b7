#pragma once

#include <string>

#include "convex/nearest_point/proof/exact_solution.hpp"

namespace convex::inline proof {

/// The rows that a solve in doubles ends on, as a guess for an exact one: those of its answer, or those that
/// its Farkas weights combine.
std::vector<Index> likely_active_rows(const NearestPointProblem&);

/// The exact solution as one in doubles: every number the nearest double, `error_bound` a proved bound on
/// what that rounding makes of q, and `residuals` left out.
Solution rounded(const ExactProblem&, const ExactSolution&, const Accuracy&);

/// Farkas weights of rows with these s as doubles: integers that doubles hold stay as they are; others are
/// measured by a power of two near the smallest and rounded to the side on which w·s is no less than before.
Vector rounded_weights(const IntegerVector& weights, const IntegerVector& s);

/// The method: the exact solution of the doubles as they stand, rounded at the end. Throws InvalidInput as
/// `validate` and `exact_problem` do.
Solution exact_method(const NearestPointProblem&, const Accuracy&);

/// Empty, or why fractions are out of reach: they are dense, and take a minute at some hundreds of rows.
std::string exact_applies(const NearestPointProblem&);

/// An upper bound on ||x - q||_A, q in fractions and x in doubles, exact but for its last digits.
double distance_above(const ExactProblem&, const Vector& x, const ExactVector& q);

}  // namespace convex::inline proof
