#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string_view>

#include "convex/nearest_point/multipliers/exact_multipliers.hpp"
#include "mechanics/gauss_solution.hpp"

namespace mechanics {

/// The answer to Gauss' problem in fractions: what `GaussSolution` says, with no tolerance anywhere.
struct ExactGaussSolution {
  convex::ExactSolution primal;
  convex::ExactMultipliers multipliers;
  convex::ExactVector reaction;  ///< R = A q'' - z: n
  convex::Fraction gauss;
  GaussSolution rounded;  ///< all of it as the nearest doubles
  bool is_whole = true;   ///< false: the acceleration alone, the rest takes too many word operations
};

/// `problem`: the same in doubles, which guess the active rows where `rows` does not. The status is
/// `gave_up`, and the rest empty, where the acceleration takes more word operations. Throws InvalidInput as
/// `convex::exact_problem` does.
ExactGaussSolution solve_exactly(const convex::ExactProblem& exact,
                                 const convex::NearestPointProblem& problem, const GaussOptions&,
                                 const std::vector<Index>& rows = {},
                                 double most_words = std::numeric_limits<double>::infinity());

/// Whether the method had to ask fractions for the answer.
bool is_decided_in_fractions(const convex::Solution&);

/// What a solve in doubles left open of the data as they are (`convex::open_question`), of q or of the
/// multipliers; empty where nothing is.
std::string_view open_question_of(const convex::NearestPointProblem&, const GaussSolution&);

/// Whether an answer is as accurate as doubles are: what is not good enough then asks for less than rounding.
bool is_at_rounding(const convex::Solution&);

/// Decides what a solve in doubles left open, could not end, or may owe to rounding or to the radii of the
/// data (rows that depend on each other), on the data as they are: the answer becomes the exact one, rounded.
/// `data` is asked for them only then; none when they cannot be had. The q of a method that was named stays
/// its own: where the numbers are exact and it solved, multipliers and hypothesis are those of the exact
/// answer. What takes more than accuracy.limit times `convex::most_word_operations` stays as it is, and says
/// what is open (`Solution::undecided`): in numbers that are exact it is solved only where a bound is proved
/// in doubles.
void decide_on_exact_data(GaussSolution&, const convex::NearestPointProblem&, const GaussOptions&,
                          const std::function<std::optional<convex::ExactProblem>()>& data);

/// The exact solution of exact data, rounded, where that takes at most accuracy.limit times
/// `convex::most_word_operations`; else false, and nothing is changed but `was_too_long`. open: why it is
/// asked for. The model stays that of the answer before, if there is one: what fractions were asked is said
/// of its islands.
bool solve_on_exact_data(GaussSolution&, const convex::ExactProblem&, const convex::NearestPointProblem&,
                         const GaussOptions&, std::string_view open);

/// The hypothesis that every contact persists, and the rule of dropping negative multipliers, judged in
/// fractions against the true solution.
/// None where that takes more word operations.
std::optional<Hypothesis> exact_hypothesis(const convex::ExactProblem&, const convex::ExactSolution& truth,
                                           double most_words = std::numeric_limits<double>::infinity());

}  // namespace mechanics
