#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "cli/python/arrays.hpp"
#include "cli/python/bindings.hpp"
#include "convex/invalid_input.hpp"
#include "convex/laws/trial.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// gamma where W = I/gamma.
double step_of(const convex::Metric& W) {
  const convex::Vector& d = W.diagonal();
  const bool is_diagonal =
      W.kind() == convex::MetricKind::identity || W.kind() == convex::MetricKind::diagonal;
  if (!is_diagonal || d.size() == 0 || (d.array() != d[0]).any())
    throw convex::InvalidInput("the metric is no multiple of the identity; write the prox for W.gram");
  return 1 / d[0];
}

}  // namespace

void add_metric(py::module_& module) {
  const auto checked = [](const convex::Metric& W, const py::object& x, const char* name) {
    convex::Vector numbers = vector_of(x, name);
    if (numbers.size() != W.dimension())
      throw convex::InvalidInput(std::string(name) + ": " + std::to_string(numbers.size()) +
                                 " entries; give " + std::to_string(W.dimension()));
    return numbers;
  };
  py::class_<convex::Metric>(module, "Metric", R"(A Euclidean metric (x|y) = x.Wy, factored once.

W: a symmetric positive definite matrix, n by n (numpy or scipy.sparse), or its diagonal. Where a matrix is used
again and again, a Metric saves its factorisation. W maps vectors to covectors.)")
      .def(py::init([](const py::object& W) {
             if (W.is_none()) throw convex::InvalidInput("W: None; give a matrix, or a diagonal");
             return metric_of(W, 0, "W");
           }),
           py::arg("W"))
      .def_property_readonly("dimension", &convex::Metric::dimension, "n")
      .def("__repr__",
           [](const convex::Metric& W) {
             const char* const kinds[] = {"identity", "diagonal", "dense", "sparse"};
             const std::string n = std::to_string(W.dimension());
             return "Metric(" + n + " by " + n + ", " + kinds[static_cast<int>(W.kind())] + ")";
           })
      .def_property_readonly(
          "gram",
          [](const convex::Metric& W) {
            const convex::Matrix gram = convex::gram_matrix(W);
            py::array_t<double> made({gram.rows(), gram.cols()});
            Eigen::Map<convex::RowMatrix>(made.mutable_data(), gram.rows(), gram.cols()) = gram;
            return made;
          },
          "W, n by n")
      .def_property_readonly("step", step_of, "gamma where W = I/gamma; InvalidInput otherwise")
      .def(
          "multiply",
          [checked](const convex::Metric& W, const py::object& x) {
            return array_of(W.multiply(checked(W, x, "x")));
          },
          py::arg("x"), "Wx: from a vector to its covector")
      .def(
          "solve",
          [checked](const convex::Metric& W, const py::object& c) {
            return array_of(W.solve(checked(W, c, "c")));
          },
          py::arg("c"), "W^-1 c: from a covector to its vector")
      .def(
          "inner",
          [checked](const convex::Metric& W, const py::object& x, const py::object& y) {
            return W.inner(checked(W, x, "x"), checked(W, y, "y"));
          },
          py::arg("x"), py::arg("y"), "(x|y) = x.Wy")
      .def(
          "norm",
          [checked](const convex::Metric& W, const py::object& x) { return W.norm(checked(W, x, "x")); },
          py::arg("x"), "sqrt((x|x))");
}

}  // namespace python
