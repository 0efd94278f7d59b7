#pragma once

#include "mechanics/gauss_problem.hpp"

namespace mechanics::inline singular_states {

/// Two-sided rows whose gradients may vanish or depend on each other: a quick look in doubles, which passes
/// over nothing that is closer than a millionth to it.
struct SuspectRows {
  std::vector<Index> rows;    ///< of the problem
  std::vector<Index> unseen;  ///< rows of groups too large for a dense factor
};
SuspectRows suspect_rows(const GaussProblem&, const Vector& unit);

}  // namespace mechanics::inline singular_states
