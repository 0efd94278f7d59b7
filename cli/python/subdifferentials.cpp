#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/python/arrays.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/expression.hpp"
#include "cli/python/fractions.hpp"
#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/sets/subdifferential.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::InvalidInput;
using convex::Subdifferential;

struct SetOfSubgradients {
  std::string f;
  convex::Fractions x;
  bool of_set = false;
  Subdifferential at;

  const Subdifferential& not_empty() const {
    if (at.is_empty()) throw InvalidInput("the subdifferential is empty: f has no finite slope at x");
    return at;
  }
  convex::Fractions covector(const py::object& v, const char* name) const {
    convex::Fractions read = fractions_of(v, name);
    if (read.size() != at.n)
      throw InvalidInput(std::string(name) + ": " + convex::counted(read.size(), "entry", "entries") +
                         "; give " + std::to_string(at.n) + ", as x has");
    return read;
  }
};

std::shared_ptr<SetOfSubgradients> find_subgradients(const Expression& f, const py::object& x,
                                                     const py::object& W) {
  SetOfSubgradients found;
  found.x = fractions_of(x, "x");
  const auto n = static_cast<convex::Index>(found.x.size());
  const convex::ExactGram gram = gram_of(W, n);
  const convex::Function made = f.in(rounded(gram));
  found.f = to_text(f.call());
  found.of_set = made.facts().indicator;
  const py::gil_scoped_release released;
  made(nearest(found.x));  // checks the number of entries
  found.at = convex::subdifferential(f.call(), gram, found.x);
  return std::make_shared<SetOfSubgradients>(std::move(found));
}

py::object direction_rows(const convex::IntegerRows& directions) {
  py::list made;
  for (const convex::IntegerVector& row : directions) {
    convex::Fractions entries;
    for (const convex::Integer& entry : row) entries.push_back({entry});
    made.append(fraction_list(entries));
  }
  return made;
}

py::dict dict_of(const convex::PolyhedralCone& K) {
  py::dict made;
  made["generators"] = direction_rows(K.generators);
  made["lines"] = direction_rows(K.lines);
  made["halfspaces"] = direction_rows(K.halfspaces);
  made["equations"] = direction_rows(K.equations);
  return made;
}

py::list halfspaces(const std::vector<convex::ExactHalfspace>& all) {
  py::list made;
  for (const convex::ExactHalfspace& one : all) {
    convex::Fractions entries;
    for (const convex::Integer& entry : one.normal) entries.push_back({entry});
    made.append(py::make_tuple(fraction_list(entries), fraction_list({{one.limit}})[py::int_(0)]));
  }
  return made;
}

py::object polyhedron(const SetOfSubgradients& found) {
  if (!found.at.polyhedron || found.at.is_empty()) return py::none();
  const convex::ExactPolyhedron& P = *found.at.polyhedron;
  py::dict made;
  py::list vertices;
  for (const convex::Fractions& vertex : P.vertices) vertices.append(fraction_list(vertex));
  made["vertices"] = vertices;
  made["rays"] = direction_rows(P.rays);
  made["lines"] = direction_rows(P.lines);
  made["halfspaces"] = halfspaces(P.halfspaces);
  made["equations"] = halfspaces(P.equations);
  return made;
}

py::object projection(const SetOfSubgradients& found, const py::object& u, const py::object& V) {
  const convex::Vector point = nearest(found.covector(u, "u"));
  const convex::Metric metric = metric_of(V, point.size(), "V");
  if (metric.dimension() != point.size())
    throw InvalidInput("V: " + convex::counted(metric.dimension(), "row", "rows") + "; give " +
                       std::to_string(point.size()) + ", one per entry of u");
  return array_of(found.not_empty().projection(point, metric));
}

}  // namespace

void add_subdifferentials(py::module_& module) {
  using Found = SetOfSubgradients;
  py::class_<Found, std::shared_ptr<Found>>(
      module, "Subdifferential",
      R"(All subgradients of f at x: v with f(u) >= f(x) + v.(u - x) for all u (Moreau 1963).

v are covectors of the plain product: x = prox(f, z, W) exactly when W(z - x) is one of them. Of the indicator of a
set C they are its normal cone.)")
      .def_property_readonly(
          "f", [](const Found& found) { return found.f; }, "f, as text")
      .def_property_readonly(
          "x", [](const Found& found) { return fraction_list(found.x); }, "the point, in fractions")
      .def_property_readonly(
          "is_empty", [](const Found& found) { return found.at.is_empty(); },
          "outside the domain, or where f has a vertical slope")
      .def_property_readonly(
          "is_single", [](const Found& found) { return found.at.is_single(); },
          "whether f has a gradient at x")
      .def_property_readonly(
          "is_exact", [](const Found& found) { return found.at.is_exact; },
          "whether no number of the set is rounded")
      .def_property_readonly(
          "set",
          [](const Found& found) -> py::object {
            if (found.at.is_empty()) return py::none();
            return py::cast(std::make_shared<SetExpression>(found.at.set->call));
          },
          "as a Set of the language; None when it is empty")
      .def_property_readonly(
          "polyhedron", polyhedron,
          "vertices, rays, lines, halfspaces and equations in fractions; None where it is none")
      .def(
          "__contains__",
          [](const Found& found, const py::object& v) { return found.at.contains(found.covector(v, "v")); },
          py::arg("v"), "Is v a subgradient at x? In fractions where is_exact, else up to the tolerance.")
      .def(
          "support",
          [](const Found& found, const py::object& d) {
            return found.not_empty().support(found.covector(d, "d"));
          },
          py::arg("d"), "sup of d.v over the set: the directional derivative f'(x; d); may be inf.")
      .def("projection", projection, py::arg("u"), py::arg("V") = py::none(),
           "The subgradient nearest to u, in the norm of V.")
      .def_property_readonly(
          "least",
          [](const Found& found) {
            const convex::Index n = static_cast<convex::Index>(found.at.n);
            return array_of(
                found.not_empty().projection(convex::Vector::Zero(n), convex::Metric::identity(n)));
          },
          "the subgradient of least Euclidean norm")
      .def_property_readonly(
          "tangent_cone",
          [](const Found& found) -> py::object {
            if (!found.of_set || !found.at.polyhedron || found.at.is_empty()) return py::none();
            return dict_of(tangent_cone(found.at));
          },
          "of a polyhedron, by generators, lines, halfspaces, equations; None elsewhere")
      .def(
          "critical_cone",
          [](const Found& found, const py::object& v) {
            return dict_of(critical_cone(found.at, found.covector(v, "v")));
          },
          py::arg("v"), "{d tangent : v.d = 0} for a normal v of a polyhedron.")
      .def("__repr__", [](const Found& found) {
        const std::string what = found.at.is_empty() ? "empty" : to_text(found.at.set->call);
        return "Subdifferential(" + found.f + "; " + what + ")";
      });
  module.def("subdifferential", find_subgradients, py::arg("f"), py::arg("x"), py::arg("W") = py::none());
}

}  // namespace python
