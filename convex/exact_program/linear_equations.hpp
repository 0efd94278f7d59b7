#pragma once

#include <optional>

#include "convex/exact_program/exact_program.hpp"

namespace convex::inline exact_programs {

/// row·u = right.
struct ExactEquation {
  ExactRow row;
  Fraction right;
};

/// A solution of linear equations in fractions, nearest to `guess` in no norm: unknowns that the equations
/// leave free keep their guess. None when the equations contradict each other. Elimination on the nonzero
/// entries, the row with the fewest first (Markowitz 1957), by entries that are not small beside their row's.
std::optional<Fractions> solve_near(std::vector<ExactEquation> equations, const Fractions& guess);

}  // namespace convex::inline exact_programs
