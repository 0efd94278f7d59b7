#include "convex/nearest_point/guess.hpp"

#include <string>

#include "convex/invalid_input.hpp"

namespace convex {

void validate_guess(const NearestPointProblem& problem, const std::vector<Index>& guess) {
  for (const Index a : guess)
    if (a < 0 || a >= problem.rows())
      throw InvalidInput("guess: no row " + std::to_string(a) + "; rows run from 0 to " +
                         std::to_string(problem.rows() - 1));
}

}  // namespace convex
