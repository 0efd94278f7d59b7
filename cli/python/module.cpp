#include <pybind11/pybind11.h>

#include "cli/python/bindings.hpp"

PYBIND11_MODULE(_moreau, module) {
  module.doc() = "The compiled part of moreau; import moreau instead.";
  module.attr("__version__") = MOREAU_VERSION;
  for (const auto add :
       {python::add_errors, python::add_metric, python::add_nearest_point, python::add_functions,
        python::add_proxes, python::add_laws, python::add_maps, python::add_subdifferentials,
        python::add_symbols, python::add_documents, python::add_atlas, python::add_motion})
    add(module);
}
