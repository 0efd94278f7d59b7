#pragma once

#include <string>
#include <vector>

#include "convex/vector.hpp"

namespace cli::inline problem_files {

/// A matrix from a Matrix Market file (Boisvert, Pozo, Remington 1996): coordinate or array, real or integer,
/// general or symmetric. rows (-1: any number) and columns are those that it
/// must have, checked before memory is taken. Throws InvalidInput naming the file, its line and what is
/// wrong.
convex::SparseMatrix read_matrix_market(const std::string& path, convex::Index rows, convex::Index columns);

/// The numbers of such a file as text: integers of a file of integers exactly, others as their doubles.
std::vector<std::vector<std::string>> read_matrix_digits(const std::string& path, convex::Index rows,
                                                         convex::Index columns);

/// Whether it is a file of integers, and holds some that are no doubles.
bool holds_long_integers(const std::string& path, convex::Index rows, convex::Index columns);

}  // namespace cli::inline problem_files
