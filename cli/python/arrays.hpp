#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace pybind11 {
class handle;
class object;
}  // namespace pybind11

/// The Python module `moreau` (docs/python.md).
namespace python {

/// Numbers of Python (lists, numpy) as vectors and matrices of doubles. `name` is the argument's, for
/// messages. Each throws InvalidInput where it is something else: complex, of another number of axes.
convex::Vector vector_of(pybind11::handle numbers, const char* name);
convex::Matrix matrix_of(pybind11::handle numbers, const char* name);

/// W: a `Metric`, a matrix (numpy or scipy.sparse), the diagonal of one, or None for the identity in n
/// dimensions.
convex::Metric metric_of(pybind11::handle W, convex::Index n, const char* name);

/// Rows: a matrix, numpy or scipy.sparse.
convex::ConstraintRows rows_of(pybind11::handle U, const char* name);

/// Numbers of rows, as integers. A mask of booleans is refused: read as integers it would name rows 0 and 1.
std::vector<convex::Index> row_numbers(pybind11::handle numbers, const char* name);

/// Is it a scipy.sparse matrix?
bool is_sparse(pybind11::handle numbers);

/// A read-only view of a vector that `owner` keeps alive; nothing is copied.
pybind11::object view_of(const convex::Vector&, pybind11::handle owner);
/// A new array.
pybind11::object array_of(const convex::Vector&);

}  // namespace python
