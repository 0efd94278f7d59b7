#pragma once

#include <string>

#include "convex/vector.hpp"

namespace cli {

/// A matrix from a Matrix Market file (Boisvert, Pozo, Remington 1996): coordinate or array, real or integer,
/// general or symmetric. Throws InvalidInput naming the file, its line and what is wrong.
convex::SparseMatrix read_matrix_market(const std::string& path);

}  // namespace cli
