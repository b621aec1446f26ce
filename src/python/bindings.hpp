#pragma once

#include <pybind11/pybind11.h>

namespace fiber::python {

// Each adds the classes and functions of one file to the module.
void bind_fibers(pybind11::module& module);
void bind_contacts(pybind11::module& module);
void bind_environment(pybind11::module& module);
void bind_check(pybind11::module& module);
void bind_engine(pybind11::module& module);
void bind_device_contacts(pybind11::module& module);
void bind_device_proximity(pybind11::module& module);
void bind_topology(pybind11::module& module);
void bind_simulation(pybind11::module& module);
void bind_files(pybind11::module& module);

}  // namespace fiber::python
