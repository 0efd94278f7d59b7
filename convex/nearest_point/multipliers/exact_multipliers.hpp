#pragma once

#include <optional>

#include "convex/nearest_point/multipliers/multiplier_tableau.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"

namespace convex::inline multiplier_sets {

using ExactInterval = MultiplierRange<Fraction>;

/// All multipliers of a solved problem, in fractions; as `Multipliers`, with no tolerance anywhere.
struct ExactMultipliers {
  bool unique = true;
  ExactVector least_norm;  ///< m
  std::optional<std::vector<ExactInterval>> ranges;
  /// A basis of {mu : Uᵀmu = 0} over the tight rows, entries that are not 0.
  std::vector<std::vector<std::pair<Index, Fraction>>> null_space;
  std::vector<Index> tight;  ///< rows with u_a·q = s_a, in order
};

/// `want_ranges`: two linear programs a multiplier in fractions, so leave it out for many rows.
ExactMultipliers exact_multipliers(const ExactProblem&, const ExactSolution&, bool want_ranges);
/// The same; none where they would take more than so many word operations, as the sizes of the numbers tell
/// beforehand.
std::optional<ExactMultipliers> exact_multipliers(const ExactProblem&, const ExactSolution&, bool want_ranges,
                                                  double most_words);

/// An estimate of the word operations of the ranges of so many multipliers, that many of them of rows that
/// depend on the others: two linear programs a multiplier, each of a few pivots.
double words_of_ranges(std::size_t multipliers, std::size_t dependent);

/// The nearest doubles.
Multipliers rounded(const ExactMultipliers&);

}  // namespace convex::inline multiplier_sets
