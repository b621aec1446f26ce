#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace fiber::python {

namespace py = pybind11;

// Arrays in memory of a device, from and to other libraries, by the two protocols that there are:
// CUDA's array interface, version 3 (numba's documentation), and DLPack's DLManagedTensor of before
// its versions (github.com/dmlc/dlpack), which every library that knows DLPack takes.

/// Points (n, 3), one after the other, where another library has them.
struct DevicePoints {
  std::uintptr_t address = 0;
  bool is_single = false;  ///< float32, not float64
  py::object owner;        ///< keeps them

  /// @param on_gpu whether they are to be on a GPU, or in memory of the host
  /// @return nothing for what is to be read as an array of the host
  /// @throws py::type_error for numbers of another type, std::invalid_argument for another shape or
  ///         order, and for memory of another kind
  static std::optional<DevicePoints> of(const py::object& points, bool on_gpu,
                                        std::size_t point_count);
};

/// One array of numbers that cannot be written.
struct DeviceValues {
  const void* data = nullptr;
  std::size_t count = 0;
  std::size_t size = 0;    ///< [bytes] of each: 4 for int32, 8 for float64
  std::optional<int> gpu;  ///< nothing for memory of the host
};

/// Makes the dictionary of __cuda_array_interface__.
/// @throws py::attribute_error for values that are on no GPU
py::dict to_cuda_array_interface(const DeviceValues& values);

/// Makes the result of __dlpack_device__().
py::tuple to_dlpack_device(const DeviceValues& values);

/// Makes the result of __dlpack__().
/// @param owner held until whoever takes the array lets it go, on any thread, without Python
py::capsule to_dlpack(const DeviceValues& values, std::shared_ptr<const void> owner);

}  // namespace fiber::python
