#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// What doubles leave open, in the words of the reports.
namespace open_question {
inline constexpr std::string_view dependence = "whether rows depend on each other";
inline constexpr std::string_view touched = "whether rows that the point touches are kept";
inline constexpr std::string_view contradiction = "whether rows contradict each other";
inline constexpr std::string_view conditioning = "the digits of a nearly singular system";
}  // namespace open_question

/// The answer of a method that left a question open (`Solution::undecided`), decided in fractions on the
/// doubles as they stand: the exact solution, rounded, or a contradiction with its weights. It starts from
/// the rows of the answer, or from those that its Farkas weights combine. Where that takes more than
/// accuracy.limit times `most_word_operations`, the answer is given back as it is, not solved.
Solution decided_in_fractions(const NearestPointProblem&, Solution open, const Accuracy&);

}  // namespace convex
