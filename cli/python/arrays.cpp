#include "cli/python/arrays.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>

#include "cli/problem_file/read_metric.hpp"
#include "cli/python/options.hpp"
#include "convex/invalid_input.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Index;
using convex::InvalidInput;

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The argument as an array of doubles, itself where it is one.
Numbers numbers_of(py::handle numbers, const char* name) {
  if (py::isinstance<py::array>(numbers)) {
    const char kind = py::reinterpret_borrow<py::array>(numbers).dtype().kind();
    if (kind == 'c') throw InvalidInput(std::string(name) + ": complex numbers; give real ones");
  }
  Numbers made = Numbers::ensure(numbers);
  if (!made) {
    PyErr_Clear();
    throw InvalidInput(std::string(name) + ": not numbers, or rows of different lengths; give a list or an array of numbers");
  }
  return made;
}

std::string axes(py::ssize_t count) { return std::to_string(count) + (count == 1 ? " axis" : " axes"); }

/// The entries of a compressed matrix, whose three arrays numpy holds.
template <class Compressed>
Compressed compressed(py::handle matrix, const char* name) {
  const auto data = numbers_of(matrix.attr("data"), name);
  const auto inner =
      py::array_t<int, py::array::c_style | py::array::forcecast>::ensure(matrix.attr("indices"));
  const auto outer =
      py::array_t<int, py::array::c_style | py::array::forcecast>::ensure(matrix.attr("indptr"));
  const auto shape = py::cast<std::pair<Index, Index>>(matrix.attr("shape"));
  Compressed made = Eigen::Map<const Compressed>(shape.first, shape.second, data.size(), outer.data(),
                                                 inner.data(), data.data());
  return made;
}

/// scipy's matrix in a form, each entry once and in order.
py::object in_order(py::handle matrix, const char* form) {
  py::object made = matrix.attr(form)(py::arg("copy") = false);
  if (!py::cast<bool>(made.attr("has_canonical_format"))) {
    made = made.attr("copy")();
    made.attr("sum_duplicates")();
  }
  return made;
}

}  // namespace

bool is_sparse(py::handle numbers) {
  return !py::isinstance<py::array>(numbers) && py::hasattr(numbers, "tocsr") &&
         py::hasattr(numbers, "shape");
}

convex::Vector vector_of(py::handle numbers, const char* name) {
  const Numbers made = numbers_of(numbers, name);
  if (made.ndim() != 1)
    throw InvalidInput(std::string(name) + ": " + axes(made.ndim()) + "; give a vector, with one");
  return Eigen::Map<const convex::Vector>(made.data(), made.size());
}

convex::Matrix matrix_of(py::handle numbers, const char* name) {
  const Numbers made = numbers_of(numbers, name);
  if (made.ndim() != 2)
    throw InvalidInput(std::string(name) + ": " + axes(made.ndim()) + "; give a matrix, with two");
  return Eigen::Map<const convex::RowMatrix>(made.data(), made.shape(0), made.shape(1));
}

convex::Metric metric_of(py::handle W, Index n, const char* name) try {
  if (W.is_none()) return convex::Metric::identity(n);
  if (py::isinstance<convex::Metric>(W)) return py::cast<const convex::Metric&>(W);
  if (is_sparse(W))
    return convex::Metric::sparse(compressed<convex::SparseMatrix>(in_order(W, "tocsc"), name));
  const Numbers made = numbers_of(W, name);
  if (made.ndim() == 1)
    return convex::Metric::diagonal(Eigen::Map<const convex::Vector>(made.data(), made.size()));
  if (made.ndim() != 2)
    throw InvalidInput(std::string(name) + ": " + axes(made.ndim()) +
                       "; give a symmetric matrix, or the diagonal of one");
  // Metric::dense refuses what is not symmetric, so that rows may be read as columns; a rectangle is told as
  // such.
  return convex::Metric::dense(Eigen::Map<const convex::Matrix>(made.data(), made.shape(0), made.shape(1)));
} catch (const InvalidInput& error) {
  throw InvalidInput(cli::metric_message(error.what(), name));
}

convex::ConstraintRows rows_of(py::handle U, const char* name) {
  if (is_sparse(U)) return convex::ConstraintRows(compressed<convex::SparseRows>(in_order(U, "tocsr"), name));
  const Numbers made = numbers_of(U, name);
  if (made.ndim() != 2)
    throw InvalidInput(std::string(name) + ": " + axes(made.ndim()) +
                       "; give a matrix, one row per constraint");
  return convex::ConstraintRows(
      convex::RowMatrix(Eigen::Map<const convex::RowMatrix>(made.data(), made.shape(0), made.shape(1))));
}

std::vector<Index> row_numbers(py::handle numbers, const char* name) {
  const py::array made = py::array::ensure(numbers);
  if (!made) PyErr_Clear();
  if (made && made.dtype().kind() == 'b')
    throw InvalidInput(std::string(name) + ": booleans; give row numbers, of a mask numpy.flatnonzero(mask)");
  return option<std::vector<Index>>(numbers, name);
}

py::object view_of(const convex::Vector& x, py::handle owner) {
  py::array_t<double> view(x.size(), x.data(), owner);
  py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

py::object array_of(const convex::Vector& x) { return py::array_t<double>(x.size(), x.data()); }

}  // namespace python
