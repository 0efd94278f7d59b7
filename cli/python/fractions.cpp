#include "cli/python/fractions.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>

#include "cli/python/arrays.hpp"
#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"

namespace py = pybind11;

namespace python {

using convex::InvalidInput;

convex::Fractions fractions_of(py::handle numbers, const char* name) {
  const std::string where = name;
  if (py::isinstance<py::str>(numbers) || !py::isinstance<py::iterable>(numbers))
    throw InvalidInput(where + ": not a vector; give a list of numbers, fractions or texts such as \"1/3\"");
  convex::Fractions made;
  for (const py::handle& entry : py::reinterpret_borrow<py::iterable>(numbers)) {
    if (py::isinstance<py::float_>(entry) || py::hasattr(entry, "dtype")) {
      PyErr_Clear();
      const double value = PyFloat_AsDouble(entry.ptr());
      if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        throw InvalidInput(where + ": an entry is no number; give a vector, with one axis");
      }
      if (!std::isfinite(value)) throw InvalidInput(where + ": an entry is not finite; give finite numbers");
      made.push_back(convex::fraction(value));
      continue;
    }
    const auto value = convex::read_fraction(py::cast<std::string>(py::str(entry)));
    if (!value) throw InvalidInput(where + ": an entry is no number; give floats, fractions or \"1/3\"");
    made.push_back(lowest_terms(*value));
  }
  if (made.empty()) throw InvalidInput(where + ": empty; give at least one number");
  return made;
}

convex::ExactGram gram_of(const py::object& W, convex::Index n) {
  if (W.is_none()) return convex::identity_gram(static_cast<std::size_t>(n));
  const convex::Metric metric = metric_of(W, n, "W");
  if (metric.dimension() != n)
    throw InvalidInput("W: " + convex::counted(metric.dimension(), "row", "rows") + "; give " +
                       std::to_string(n) + ", one per entry");
  return exact_gram(metric);
}

py::object fraction_list(const convex::Fractions& x) {
  const py::object fraction = py::module_::import("fractions").attr("Fraction");
  py::list made;
  for (const convex::Fraction& entry : x) made.append(fraction(text(entry)));
  return made;
}

}  // namespace python
