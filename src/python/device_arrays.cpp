#include "src/python/device_arrays.hpp"

#include <pybind11/stl.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/text/quote.hpp"

namespace fiber::python {
namespace {

// The memory that DLPack's header describes. It is written here as the headers that distributions
// have name the same members differently.

enum DLDeviceType : std::int32_t { CPU = 1, CUDA = 2, CUDA_HOST = 3, CUDA_MANAGED = 13 };
enum DLDataTypeCode : std::uint8_t { INT = 0, FLOAT = 2 };

struct DLDevice {
  std::int32_t type;
  std::int32_t number;
};

struct DLDataType {
  std::uint8_t code;
  std::uint8_t bits;
  std::uint16_t lanes;
};

struct DLTensor {
  void* data;
  DLDevice device;
  std::int32_t dimensions;
  DLDataType type;
  std::int64_t* shape;
  std::int64_t* strides;  // in values; null in C order
  std::uint64_t byte_offset;
};

struct DLManagedTensor {
  DLTensor tensor;
  void* context;
  void (*deleter)(DLManagedTensor*);
};

constexpr const char* capsule_name = "dltensor";

void require_shape(const std::vector<std::int64_t>& shape, std::size_t point_count) {
  if (shape.size() != 2 || shape[0] != static_cast<std::int64_t>(point_count) || shape[1] != 3) {
    throw std::invalid_argument("points must have the shape (" + std::to_string(point_count) +
                                ", 3), they have " +
                                py::str(py::tuple(py::cast(shape))).cast<std::string>());
  }
}

/// @param strides in units of which a value is so many
void require_order(const std::vector<std::int64_t>& strides, std::int64_t value,
                   std::size_t point_count) {
  if (point_count > 0 && strides != std::vector<std::int64_t>{3 * value, value}) {
    throw std::invalid_argument("points on a device must lie one after the other, in C order");
  }
}

[[noreturn]] void refuse_type(const std::string& type) {
  throw py::type_error("points on a device must be float32 or float64, they are " + type);
}

/// Asks somebody else's object about itself.
template <class Value>
Value taken(const py::handle& value, const std::string& name) {
  try {
    return value.cast<Value>();
  } catch (const py::cast_error&) {
    throw py::type_error(name + " of the points is " + py::repr(value).cast<std::string>() +
                         ", which it may not be");
  }
}

template <class Value>
Value member(const py::dict& interface, const char* key) {
  const std::string name = std::string("__cuda_array_interface__['") + key + "']";
  if (!interface.contains(key)) {
    throw py::type_error("the points have no " + name);
  }
  return taken<Value>(interface[key], name);
}

/// @throws std::invalid_argument for what no array begins at
DevicePoints require_place(DevicePoints points, std::size_t point_count) {
  const std::size_t size = points.is_single ? sizeof(float) : sizeof(double);
  if (point_count > 0 && (points.address == 0 || points.address % size != 0)) {
    throw std::invalid_argument("points on a device begin at the address " +
                                std::to_string(points.address) + ", it must be a multiple of " +
                                std::to_string(size) + " above 0");
  }
  return points;
}

DevicePoints from_cuda_array(const py::object& points, std::size_t point_count) {
  const auto interface =
      taken<py::dict>(points.attr("__cuda_array_interface__"), "__cuda_array_interface__");
  require_shape(member<std::vector<std::int64_t>>(interface, "shape"), point_count);
  const auto type = member<std::string>(interface, "typestr");
  if (type != "<f4" && type != "<f8") {
    refuse_type(quote(type));
  }
  const bool is_single = type == "<f4";
  if (interface.contains("strides") && !interface["strides"].is_none()) {
    require_order(member<std::vector<std::int64_t>>(interface, "strides"), is_single ? 4 : 8,
                  point_count);
  }
  if (interface.contains("mask") && !interface["mask"].is_none()) {
    throw py::type_error("points are masked");
  }
  const auto data = member<std::pair<std::uintptr_t, bool>>(interface, "data");
  return require_place({data.first, is_single, points}, point_count);
}

bool is_of_host(std::int32_t device) { return device == CPU || device == CUDA_HOST; }

/// @throws std::invalid_argument unless it is where they are to be
void require_device(std::int32_t device, bool on_gpu) {
  const bool is_of_gpu = device == CUDA || device == CUDA_MANAGED;
  if (on_gpu ? !is_of_gpu : !is_of_host(device)) {
    throw std::invalid_argument("points are in memory of a device of DLPack's type " +
                                std::to_string(device) + ", they must be in that of " +
                                (on_gpu ? "an NVIDIA GPU" : "the host"));
  }
}

/// The capsule lets go of the array as it ends: it is not taken out of it.
DevicePoints from_dlpack(const py::object& points, bool on_gpu, std::size_t point_count) {
  const py::object given = points.attr("__dlpack__")();
  if (PyCapsule_IsValid(given.ptr(), capsule_name) == 0) {
    throw py::type_error("__dlpack__() of the points must give a capsule named 'dltensor'");
  }
  const auto capsule = py::reinterpret_borrow<py::capsule>(given);
  const DLTensor& tensor = static_cast<const DLManagedTensor*>(capsule)->tensor;
  require_device(tensor.device.type, on_gpu);
  require_shape({tensor.shape, tensor.shape + tensor.dimensions}, point_count);
  const DLDataType& type = tensor.type;
  if (type.code != FLOAT || type.lanes != 1 || (type.bits != 32 && type.bits != 64)) {
    refuse_type("of DLPack's code " + std::to_string(type.code) + " with " +
                std::to_string(type.bits) + " bits");
  }
  if (tensor.strides != nullptr) {
    require_order({tensor.strides, tensor.strides + tensor.dimensions}, 1, point_count);
  }
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(tensor.data) +
                                 static_cast<std::uintptr_t>(tensor.byte_offset);
  return require_place({address, type.bits == 32, capsule}, point_count);
}

}  // namespace

std::optional<DevicePoints> DevicePoints::of(const py::object& points, bool on_gpu,
                                             std::size_t point_count) {
  if (py::hasattr(points, "__cuda_array_interface__")) {
    const DevicePoints found = from_cuda_array(points, point_count);
    if (!on_gpu) {
      throw std::invalid_argument(
          "points are in memory of an NVIDIA GPU, they must be in that of the host");
    }
    return found;
  }
  if (py::isinstance<py::array>(points) || !py::hasattr(points, "__dlpack__")) {
    return std::nullopt;
  }
  const std::int32_t device = taken<std::pair<std::int32_t, std::int32_t>>(
                                  points.attr("__dlpack_device__")(), "__dlpack_device__()")
                                  .first;
  if (on_gpu && is_of_host(device)) {
    return std::nullopt;  // it is copied from there
  }
  require_device(device, on_gpu);
  return from_dlpack(points, on_gpu, point_count);
}

py::dict to_cuda_array_interface(const DeviceValues& values) {
  if (!values.gpu) {
    throw py::attribute_error(
        "contacts of the device 'host' are on no GPU: use to_host() or __dlpack__()");
  }
  py::dict interface;
  interface["shape"] = py::make_tuple(values.count);
  interface["typestr"] = values.size == sizeof(double) ? "<f8" : "<i4";
  interface["data"] = py::make_tuple(reinterpret_cast<std::uintptr_t>(values.data), true);
  interface["version"] = 3;
  return interface;
}

py::tuple to_dlpack_device(const DeviceValues& values) {
  return py::make_tuple(static_cast<std::int32_t>(values.gpu ? CUDA : CPU), values.gpu.value_or(0));
}

py::capsule to_dlpack(const DeviceValues& values, std::shared_ptr<const void> owner) {
  /// Lives as long as the tensor that points to it.
  struct Shared {
    DLManagedTensor managed;
    std::int64_t shape;
    std::shared_ptr<const void> owner;
  };
  const bool is_double = values.size == sizeof(double);
  auto shared = std::make_unique<Shared>();
  shared->owner = std::move(owner);
  shared->shape = static_cast<std::int64_t>(values.count);
  shared->managed.tensor = {
      const_cast<void*>(values.data),
      {values.gpu ? CUDA : CPU, values.gpu.value_or(0)},
      1,
      {is_double ? FLOAT : INT, static_cast<std::uint8_t>(8 * values.size), 1},
      &shared->shape,
      nullptr,
      0};
  shared->managed.context = shared.get();
  shared->managed.deleter = [](DLManagedTensor* managed) {
    delete static_cast<Shared*>(managed->context);
  };
  // Whoever takes the array renames the capsule, and calls the deleter when it is done with it.
  PyObject* const capsule = PyCapsule_New(&shared->managed, capsule_name, [](PyObject* ending) {
    if (PyCapsule_IsValid(ending, capsule_name) != 0) {
      auto* const managed =
          static_cast<DLManagedTensor*>(PyCapsule_GetPointer(ending, capsule_name));
      managed->deleter(managed);
    }
  });
  if (capsule == nullptr) {
    throw py::error_already_set();
  }
  shared.release();
  return py::reinterpret_steal<py::capsule>(capsule);
}

}  // namespace fiber::python
