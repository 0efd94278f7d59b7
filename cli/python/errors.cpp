#include <pybind11/pybind11.h>

#include "cli/python/bindings.hpp"
#include "convex/invalid_input.hpp"

namespace py = pybind11;

namespace python {
namespace {

PyObject* invalid_input = nullptr;

/// InvalidInput with the place in the text, where it came from one: `line` and `column`, else None.
py::object python_error(const convex::InvalidInput& error) {
  py::object made = py::reinterpret_borrow<py::object>(invalid_input)(error.what());
  const auto& place = error.place();
  made.attr("line") = place ? py::object(py::int_(place->line)) : py::none();
  made.attr("column") = place ? py::object(py::int_(place->column)) : py::none();
  py::list others;
  for (const convex::InvalidInput& other : error.others()) others.append(python_error(other));
  made.attr("others") = others;
  return made;
}

}  // namespace

void add_errors(py::module_& module) {
  invalid_input = PyErr_NewExceptionWithDoc(
      "moreau.InvalidInput",
      "The input is wrong. The message is the program's: where, what is wrong; what to do.\n\n"
      "line, column: the place in the text that the input came from, or None. others: what else is wrong in "
      "it.",
      PyExc_ValueError, nullptr);
  module.attr("InvalidInput") = py::reinterpret_borrow<py::object>(invalid_input);
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const convex::InvalidInput& invalid) {
      PyErr_SetObject(invalid_input, python_error(invalid).ptr());
    }
  });
}

}  // namespace python
