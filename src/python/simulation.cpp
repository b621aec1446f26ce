#include "src/python/bindings.hpp"

namespace fiber::python {
void bind_simulation(pybind11::module& /*module*/) {}
}  // namespace fiber::python
