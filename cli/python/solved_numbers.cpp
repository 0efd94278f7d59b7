#include "cli/python/solved_numbers.hpp"

#include <string>

#include "convex/invalid_input.hpp"

namespace python {
namespace {

convex::Solution solved(const convex::NearestPointProblem& problem, const SolveChoice& choice) {
  if (const std::string why = choice.method->applies(problem); !why.empty())
    throw convex::InvalidInput("method \"" + std::string(choice.method->name) + "\": " + why);
  return choice.method->solve(problem, choice.accuracy);
}

}  // namespace

SolvedNumbers::SolvedNumbers(convex::NearestPointProblem problem, const SolveChoice& choice)
    : problem_(std::move(problem)),
      solution_(solved(problem_, choice)),
      tolerance_(choice.accuracy.tolerance) {}

const convex::Multipliers& SolvedNumbers::multipliers() const {
  constexpr convex::Index most_ranges = 1000;  // beyond, two linear programs each take long
  if (!multipliers_)
    multipliers_ = convex::multipliers(problem_, solution_, tolerance_, problem_.rows() <= most_ranges);
  return *multipliers_;
}

const convex::Vector& SolvedNumbers::reaction() const {
  if (!reaction_) reaction_ = problem_.U.transpose_times(solution_.lambda);
  return *reaction_;
}

}  // namespace python
