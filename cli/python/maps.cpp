#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/python/arrays.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/fractions.hpp"
#include "cli/python/options.hpp"
#include "convex/counted.hpp"
#include "convex/laws/map_laws.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Index;
using convex::Vector;

convex::ExactMetric metric_in_fractions(const py::object& W, Index n) {
  if (W.is_none()) return convex::identity_metric(n);
  const convex::Metric metric = metric_of(W, n, "W");
  if (metric.dimension() != n)
    throw convex::InvalidInput("W: " + convex::counted(metric.dimension(), "row", "rows") + "; give " +
                               std::to_string(n) + ", one per entry of T z");
  return exact_metric(metric);
}

py::object list_of(const convex::ExactVector& x) {
  convex::Fractions entries;
  for (const convex::Integer& entry : x.numerators)
    entries.push_back(convex::lowest_terms({entry, x.denominator}));
  return fraction_list(entries);
}

py::object counterexample(const convex::MapVerdict& verdict) {
  if (!verdict.counterexample) return py::none();
  const convex::MapCounterexample& found = *verdict.counterexample;
  py::dict made;
  made["law"] = found.law == convex::MapLaw::nonexpansive ? "nonexpansive" : "cyclically monotone";
  py::list points, images, radii;
  for (const convex::ExactVector& z : found.points) points.append(list_of(z));
  for (const convex::MapImage& image : found.images) {
    images.append(list_of(image.value));
    radii.append(image.radius);
  }
  made["points"] = points;
  made["images"] = images;
  made["radii"] = radii;
  made["excess"] = fraction_list({found.excess})[py::int_(0)];
  return made;
}

py::dict map_laws(const py::object& T, Index n, const py::object& W, double low, double high) {
  if (n < 1) throw convex::InvalidInput("n: not positive; give the number of entries that T takes");
  if (!(low < high)) throw convex::InvalidInput("box: the first bound is not below the second");
  const convex::Map map = convex::map_of(
      [&](const Vector& z) {
        const py::object image = T(array_of(z));
        Vector x = vector_of(image, "T");
        if (x.size() != z.size())
          throw convex::InvalidInput("T: " + convex::counted(x.size(), "entry", "entries") +
                                     " at a point of " + std::to_string(z.size()) + "; return as many");
        return x;
      },
      n);
  convex::MapSamples samples;
  samples.low = low;
  samples.high = high;
  const convex::MapVerdict verdict = laws(map, metric_in_fractions(W, n), samples);
  if (verdict.points == 0)
    throw convex::InvalidInput("T: no finite value at any point tried; give another box");
  py::dict made;
  made["counterexample"] = counterexample(verdict);
  made["points"] = verdict.points;
  made["undefined"] = verdict.undefined;
  made["asymmetry"] = verdict.asymmetry;
  return made;
}

}  // namespace

void add_maps(py::module_& module) { module.def("map_laws", map_laws); }

}  // namespace python
