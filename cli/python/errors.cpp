#include <pybind11/pybind11.h>

#include "cli/python/bindings.hpp"
#include "convex/invalid_input.hpp"

namespace py = pybind11;

namespace python {
namespace {

PyObject* invalid_input = nullptr;

/// InvalidInput with the place in the text, where it came from one: `line` and `column`, else None.
void raise(const convex::InvalidInput& error) {
  py::object raised = py::reinterpret_borrow<py::object>(invalid_input)(error.what());
  const auto& place = error.place();
  raised.attr("line") = place ? py::object(py::int_(place->line)) : py::none();
  raised.attr("column") = place ? py::object(py::int_(place->column)) : py::none();
  PyErr_SetObject(invalid_input, raised.ptr());
}

}  // namespace

void add_errors(py::module_& module) {
  invalid_input = PyErr_NewExceptionWithDoc(
      "moreau.InvalidInput",
      "The input is wrong. The message is the program's: where, what is wrong; what to do.\n\n"
      "line, column: the place in the text that the input came from, or None.",
      PyExc_ValueError, nullptr);
  module.attr("InvalidInput") = py::reinterpret_borrow<py::object>(invalid_input);
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const convex::InvalidInput& invalid) {
      raise(invalid);
    }
  });
}

}  // namespace python
