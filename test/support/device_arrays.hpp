#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/cuda/device.hpp"
#include "test/support/cuda_tree.hpp"

namespace fiber::test {

/// What is on the device, as vectors.
class DeviceArrays {
 public:
  DeviceArrays() : device_(make_test_device()) {}

  template <class T>
  std::shared_ptr<T> put(const std::vector<T>& values) {
    const std::shared_ptr<void> array =
        device_->make_array(values.data(), values.size() * sizeof(T));
    return {array, static_cast<T*>(array.get())};
  }
  template <class T>
  std::vector<T> get(const T* from, std::size_t count) {
    std::vector<T> values(count);
    device_->read(from, count * sizeof(T), values.data());
    return values;
  }

 private:
  std::unique_ptr<Device> device_;
};

template <class Number>
std::vector<Number> coordinates_of(const FiberAssembly& fibers) {
  std::vector<Number> coordinates;
  for (const Eigen::Vector3d& point : fibers.points()) {
    for (const double value : point) {
      coordinates.push_back(static_cast<Number>(value));
    }
  }
  return coordinates;
}

/// @param contacts those of run_tree for the same
inline void expect_same(DeviceArrays& arrays, const DeviceProximity::Contacts& found,
                        const FiberAssembly& fibers, const std::vector<Contact>& contacts) {
  ASSERT_EQ(found.count, contacts.size());
  const std::vector<std::uint32_t> a = arrays.get(found.a, found.count);
  const std::vector<std::uint32_t> b = arrays.get(found.b, found.count);
  const std::vector<double> s = arrays.get(found.s, found.count);
  const std::vector<double> t = arrays.get(found.t, found.count);
  const std::vector<double> distance = arrays.get(found.distance, found.count);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    ASSERT_EQ(a[i], fibers.offsets()[contact.fiber_a] + contact.segment_a);
    ASSERT_EQ(b[i], fibers.offsets()[contact.fiber_b] + contact.segment_b);
    ASSERT_EQ(s[i], contact.s);
    ASSERT_EQ(t[i], contact.t);
    ASSERT_EQ(distance[i], contact.distance);
  }
}

}  // namespace fiber::test
