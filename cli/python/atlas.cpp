#include "cli/commands/atlas.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/python/bindings.hpp"
#include "cli/python/document.hpp"
#include "cli/python/options.hpp"

namespace py = pybind11;

namespace python {
namespace {

cli::AtlasOptions atlas_options(const py::dict& given) {
  cli::AtlasOptions options;
  options.json = true;
  take(options.mean, given, "mean");
  take(options.covariance, given, "covariance");
  take_positive(options.tolerance, given, "tolerance");
  take(options.over, given, "over");
  take(options.cells, given, "cells");
  take(options.plot, given, "plot");
  return options;
}

}  // namespace

void add_atlas(py::module_& module) {
  module.def("atlas", [](const Document& document, const py::dict& given) {
    const cli::AtlasOptions options = atlas_options(given);
    const py::gil_scoped_release released;
    return told_by_keys(document.dict,
                        [&] { return cli::atlas_of_problem(document.problem, document.name, options).text; });
  });
}

}  // namespace python
