#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/proof/exact_problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline proof {

/// What doubles leave open, in the words of the reports.
namespace open_question {
inline constexpr std::string_view dependence = "whether rows depend on each other";
inline constexpr std::string_view degenerate_rows = "whether rows that the point touches are kept";
inline constexpr std::string_view zero_slacks = "whether rows that the point touches hold with equality";
inline constexpr std::string_view contradiction = "whether rows contradict each other";
inline constexpr std::string_view conditioning = "the digits of a nearly singular system";
inline constexpr std::string_view range = "numbers whose squares are beyond them";
}  // namespace open_question

/// The answer of a method that left a question open (`Solution::undecided`), decided in fractions on the
/// doubles as they stand: the exact solution, rounded, or a contradiction with its weights. It starts from
/// the rows of the answer, or from those that its Farkas weights combine. Where that takes more than
/// accuracy.limit times `most_word_operations`, the answer is given back as it is, not solved; but solved
/// where only `zero_slacks` are open, which then count as 0, as they do within the error bound.
Solution decided_in_fractions(const NearestPointProblem&, Solution open, const Accuracy&);

/// A bound of ||q - q*||_A that is proved whatever rows have to do with each other: by the duality gap, and
/// where that is not within the accuracy, by an enclosure. Infinite where neither is.
double bound_proved_in_doubles(const NearestPointProblem&, const Solution&, const Accuracy&);

/// The same by the exact point, without its multipliers: infinite where there is none, or where it takes more
/// than accuracy.limit times `most_word_operations`.
double bound_proved_in_fractions(const ExactProblem&, const Solution&, const Accuracy&);

/// The answer for a user. A row that is a sum of those held but for rounding, and not kept, may take the
/// point any distance: where that is open, nothing bounds the error but a proof in doubles, of a gap or of
/// the point enclosed, after which it is solved. Programs that make rows of their own, and count them as
/// consistent, look at the bound as if they were.
Solution bounded_where_decided(const NearestPointProblem&, Solution, const Accuracy&);

/// Whether an answer that is solved leaves the signs of zeros open: of multipliers of rows of the working set
/// that doubles cannot tell from 0. A row whose multiplier is below 0 by less than that is not held, and has
/// a slack.
bool has_open_zeros(const NearestPointProblem&, const Solution& solved);

/// The answer with these signs, and those of slacks, from fractions, where that takes a small part of the
/// word operations; beyond, it is given back as it is, and what is within the error bound counts as 0.
Solution with_signs_of_zeros(const NearestPointProblem&, Solution solved, const Accuracy&);
/// The same where some are open.
Solution with_open_signs(const NearestPointProblem&, Solution&& solved, const Accuracy&);

}  // namespace convex::inline proof
