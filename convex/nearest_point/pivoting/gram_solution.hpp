#pragma once

#include <string_view>

#include "convex/nearest_point/pivoting/gram_point.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline pivoting {

/// What is known of the point of a working set, ||·||_A, and of the rows that it touches.
struct PointError {
  double scale = 0;      ///< max(||q||_A, ||z||_(A⁻¹))
  double rounding = 0;   ///< of q to doubles
  double bound = 0;      ///< of the error of q
  double violation = 0;  ///< by the rows touched, as in `residuals`
  std::string_view undecided;
};

/// Sets the slacks of the working set apart: infinite, they are not close.
void set_held_slacks_apart(GramPoint&);

/// Lists the rows outside whose slack is not above `absolute` |s| + `by_length` times the length, until there
/// are more than `most`.
Index close_rows(GramPoint&, const NearestPointProblem&, double absolute, double by_length, Index most);

/// The solution; ||q||_A is measured again where w cancels.
void write(const NearestPointProblem&, GramPoint&, const PointError&, const Accuracy&, Solution&);

}  // namespace convex::inline pivoting
