#pragma once

#include <string>

#include "convex/nearest_point/problem.hpp"

namespace cli::inline problem_files {

/// The problem as a [projection] file that reads back to the same doubles. `comment`: lines to stand on top,
/// each with its #. A sparse A or U is a table { matrix_market = … } that names `stem`.A.mtx, `stem`.U.mtx.
std::string projection_text(const convex::NearestPointProblem&, const std::string& comment,
                            const std::string& stem);

/// A sparse matrix in the Matrix Market format, coordinates and all (not only the lower half).
std::string matrix_market_text(const convex::SparseRows&);

}  // namespace cli::inline problem_files
