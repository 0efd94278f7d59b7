#pragma once

#include <string>

#include "cli/measurement/problem_library.hpp"
#include "convex/nearest_point/multipliers/exact_multipliers.hpp"

namespace cli::inline measurement {

/// The truth of a problem in fractions, of its doubles at their exact values, and how hard it is.
struct LibraryTruth {
  convex::ExactSolution solution;
  convex::ExactMultipliers multipliers;  ///< where it is feasible
  /// One-sided rows that are tight and whose multiplier is 0 for every choice of multipliers.
  std::vector<convex::Index> weak;
  double condition = 1;  ///< of A, in doubles
  double active_condition =
      1;  ///< of the Gram matrix in A⁻¹ of the rows that the answer rests on, at unit length

  bool feasible() const { return solution.status != convex::Status::infeasible; }
  /// Tight rows less their rank.
  std::size_t dependent() const { return multipliers.null_space.size(); }
};

/// Throws InvalidInput where A is not positive definite in fractions.
LibraryTruth library_truth(const convex::NearestPointProblem&);

/// Decimals of the truth are rounded to so many significant digits.
inline constexpr int digits_of_truth = 30;

/// The truth as one JSON object: decimals as texts, and the fractions themselves where they are short.
std::string truth_json(const LibraryProblem&, const LibraryTruth&);

/// The index of a library: a heading and a line a problem, in CSV.
std::string index_heading();
std::string index_line(const LibraryProblem&, const LibraryTruth&);

}  // namespace cli::inline measurement
