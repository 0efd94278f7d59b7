#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/python/bindings.hpp"
#include "cli/python/expression.hpp"
#include "convex/laws/call_laws.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// A function of the language, and the laws of its conjugate besides; one that a user wrote by its value and
/// prox alone.
convex::LawReport laws_of(const Expression& f, convex::Index n) {
  const py::gil_scoped_release released;
  if (!f.call().made) return convex::laws(f.call(), n);
  const convex::Function made(f.call().made);
  return convex::laws(
      convex::Subject{[&made](const convex::Vector& x) { return made(x); },
                      [&made](const convex::Vector& z, const convex::Metric& W) { return made.prox(z, W); }},
      n);
}

}  // namespace

void add_laws(py::module_& module) {
  py::class_<convex::Check>(module, "Check", "One claim put to the test: it holds when value <= bound.")
      .def_readonly("name", &convex::Check::name)
      .def_readonly("value", &convex::Check::value)
      .def_readonly("bound", &convex::Check::bound)
      .def_readonly("passed", &convex::Check::passed)
      .def_readonly("counterexample", &convex::Check::counterexample)
      .def("__repr__", [](const convex::Check& check) {
        return std::string(check.passed ? "passed: " : "FAILED: ") + check.name +
               (check.counterexample.empty() ? "" : " at " + check.counterexample);
      });
  py::class_<convex::LawReport>(module, "LawReport",
                                "The laws that were tried on a function; each is the worst case.")
      .def_readonly("checks", &convex::LawReport::checks)
      .def_readonly("no_evidence", &convex::LawReport::no_evidence)
      .def_property_readonly("passed", &convex::LawReport::all_passed)
      .def("__bool__", &convex::LawReport::all_passed)
      .def("__repr__", &convex::LawReport::text);
  module.def("laws", laws_of, py::arg("f"), py::arg("n") = 3,
             R"(Puts f to the test of Moreau's theorem on n entries, at trial points in trial metrics.

z - x is a subgradient at x = prox_f z; the prox is firmly nonexpansive; one subgradient serves every metric. Of
functions of the language also that z = x + y by two routes, f(x) + g(y) = (x|y), and f** = f. What sampling finds
refutes; what it does not find proves nothing.)");
}

}  // namespace python
