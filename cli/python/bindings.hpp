#pragma once

namespace pybind11 {
class module_;
}

namespace python {

// Each adds its part to the module.

void add_errors(pybind11::module_&);
void add_metric(pybind11::module_&);
void add_nearest_point(pybind11::module_&);
void add_functions(pybind11::module_&);
void add_proxes(pybind11::module_&);
void add_laws(pybind11::module_&);
void add_maps(pybind11::module_&);
void add_subdifferentials(pybind11::module_&);
void add_symbols(pybind11::module_&);
void add_atlas(pybind11::module_&);
void add_documents(pybind11::module_&);
void add_motion(pybind11::module_&);

}  // namespace python
