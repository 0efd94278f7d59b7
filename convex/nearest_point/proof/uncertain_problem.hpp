#pragma once

#include <optional>
#include <string>

#include "convex/nearest_point/proof/exact_solution.hpp"

namespace convex::inline proof {

/// A nearest-point problem whose numbers are known to lie within radii of exact ones: |A - middle.A| <= A
/// entry by entry, and so on; A itself is symmetric. Which rows are two-sided is certain.
struct UncertainProblem {
  ExactProblem middle;
  Matrix A;     ///< n×n, >= 0, symmetric
  Vector z;     ///< n
  RowMatrix U;  ///< m×n
  Vector s;     ///< m
};

/// What holds for every problem within the radii: their solutions q* exist, and ||q* - q||_A <= radius in the
/// metric of each; or none of them has a solution, which the rows with weights `farkas` prove.
struct EnclosedSolution {
  Status status = Status::solved;
  ExactVector q;
  double radius = 0;
  /// ||x||_A <= stretch ||x||_A' for the metric A of every problem and that of the middle, A'.
  double stretch = 1;
  IntegerVector farkas;
};

/// Solves the middle problem with its uncertain rows a little raised, so that q (moved a little to meet the
/// two-sided rows) satisfies the rows of every problem within the radii; docs/proof.md, section 7, has the
/// argument. `guess`: rows thought to be active. None where this proves nothing: rows that contradict each
/// other unless they are related exactly (two opposite walls at a distance that is known to a radius only),
/// dependent two-sided rows that are uncertain, radii too wide.
std::optional<EnclosedSolution> enclosed_solution(const UncertainProblem&, const std::vector<Index>& guess);

/// An enclosed solution in decimals: ||q* - entries||_A <= radius.
struct Decimals {
  std::vector<std::string> entries;
  double radius = 0;
};

/// With so many significant digits at most. Of a solved one.
Decimals decimals(const UncertainProblem&, const EnclosedSolution&, int digits);

/// At least ||x - q*||_A for the solution q* of every problem within the radii, in its metric. Of a solved
/// one.
double distance_above(const UncertainProblem&, const EnclosedSolution&, const Vector& x);

}  // namespace convex::inline proof
