#pragma once

#include <functional>
#include <optional>

#include "convex/nearest_point/proof/exact_problem.hpp"
#include "mechanics/gauss_solution.hpp"

namespace mechanics {

/// Counts in an answer what each number's rounding to the nearest double makes of it: the error bound becomes
/// one on the distance from the solution of the data as they are, and the status is judged by that. It is
/// proved for all data within a rounding (`convex::enclosed_error`); where that proves too little, the
/// distance from the solution in fractions, where this takes at most accuracy.limit times
/// `convex::most_word_operations`. `data` is asked for them only then; none when they cannot be had.
/// Where neither tells, or the data have no solution, the answer is inaccurate and nothing bounds its error;
/// a contradiction that is not one of the data, or may not be, is given up. Either says what is open
/// (`Solution::undecided`).
void count_rounding_of_data(GaussSolution&, const convex::NearestPointProblem&, const GaussOptions&,
                            const std::function<std::optional<convex::ExactProblem>()>& data);

}  // namespace mechanics
