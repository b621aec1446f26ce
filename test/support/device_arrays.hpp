#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/cuda/device.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/random.hpp"

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

/// @param found arrays on the host: Contacts that went there, or HostContacts
/// @param contacts those of an engine for the same
template <class Arrays>
void expect_same(const Arrays& found, std::size_t count, const FiberAssembly& fibers,
                 const std::vector<Contact>& contacts) {
  ASSERT_EQ(count, contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    ASSERT_EQ(found.a[i], fibers.offsets()[contact.fiber_a] + contact.segment_a);
    ASSERT_EQ(found.b[i], fibers.offsets()[contact.fiber_b] + contact.segment_b);
    ASSERT_EQ(found.s[i], contact.s);
    ASSERT_EQ(found.t[i], contact.t);
    ASSERT_EQ(found.distance[i], contact.distance);
  }
}

/// The same of arrays on the device.
inline void expect_same(DeviceArrays& arrays, const DeviceProximity::Contacts& found,
                        const FiberAssembly& fibers, const std::vector<Contact>& contacts) {
  DeviceProximity::HostContacts copy;
  copy.a = arrays.get(found.a, found.count);
  copy.b = arrays.get(found.b, found.count);
  copy.s = arrays.get(found.s, found.count);
  copy.t = arrays.get(found.t, found.count);
  copy.distance = arrays.get(found.distance, found.count);
  expect_same(copy, found.count, fibers, contacts);
}

inline DeviceProximity::Options random_device_options(Random& random, const FiberAssembly& fibers) {
  DeviceProximity::Options options;
  options.margin = random.chance(0.5) ? 0.0 : 0.05 * extent_of(fibers);
  options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 3));
  options.pairing = static_cast<Pairing>(random.integer(0, 2));
  return options;
}

/// What an engine is asked for the same contacts.
inline QueryOptions same_query(const DeviceProximity::Options& options) {
  QueryOptions same = within(options.margin);
  same.neighbour_skip = options.neighbour_skip;
  same.pairing = options.pairing;
  return same;
}

}  // namespace fiber::test
