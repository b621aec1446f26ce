#include "fiber_proximity/cuda/cuda_engines.hpp"
#include "fiber_proximity/paper/paper_engines.hpp"
#include "src/python/bindings.hpp"

PYBIND11_MODULE(_native, module) {
  // The package's __init__.py describes the parts of this module.
  module.doc() = "The compiled part of fiber_proximity; import that.";
  fiber::register_paper_engines();
  fiber::register_cuda_engines();
  fiber::python::bind_fibers(module);
  fiber::python::bind_contacts(module);
  fiber::python::bind_environment(module);
  fiber::python::bind_engine(module);
  fiber::python::bind_check(module);
  fiber::python::bind_device_contacts(module);
  fiber::python::bind_device_proximity(module);
  fiber::python::bind_topology(module);
  fiber::python::bind_simulation(module);
  fiber::python::bind_files(module);
}
