#include <pybind11/pybind11.h>

#include "cli/python/bindings.hpp"
#include "cli/python/document.hpp"
#include "convex/invalid_input.hpp"

namespace py = pybind11;

namespace python {
namespace {

PyObject* invalid_input = nullptr;

/// InvalidInput with the place in the text, where it came from one: `line` and `column`, else None; with the
/// keys, where it came from a dict: `key`, else None.
py::object python_error(const convex::InvalidInput& error, const std::string* key) {
  py::object made = py::reinterpret_borrow<py::object>(invalid_input)(error.what());
  const auto& place = key == nullptr ? error.place() : std::nullopt;
  made.attr("line") = place ? py::object(py::int_(place->line)) : py::none();
  made.attr("column") = place ? py::object(py::int_(place->column)) : py::none();
  made.attr("key") = key != nullptr && !key->empty() ? py::object(py::str(*key)) : py::none();
  py::list others;
  const std::string* next = key;
  for (const convex::InvalidInput& other : error.others())
    others.append(python_error(other, next == nullptr ? nullptr : ++next));
  made.attr("others") = others;
  return made;
}

}  // namespace

void add_errors(py::module_& module) {
  invalid_input = PyErr_NewExceptionWithDoc(
      "moreau.InvalidInput",
      "The input is wrong. The message is the program's: where, what is wrong; what to do.\n\n"
      "line, column: the place in the text that the input came from, or None. key: of a dict, where it is "
      "wrong, as state.position.x, or None. others: what else is wrong in it.",
      PyExc_ValueError, nullptr);
  module.attr("InvalidInput") = py::reinterpret_borrow<py::object>(invalid_input);
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const InvalidDict& invalid) {
      PyErr_SetObject(invalid_input, python_error(invalid, invalid.keys.data()).ptr());
    } catch (const convex::InvalidInput& invalid) {
      PyErr_SetObject(invalid_input, python_error(invalid, nullptr).ptr());
    }
  });
}

}  // namespace python
