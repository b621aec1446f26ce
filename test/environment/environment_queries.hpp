#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "test/environment/random_shapes.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {

inline std::vector<EnvironmentObject> random_objects(Random& random, double extent) {
  std::vector<EnvironmentObject> objects;
  for (int i = 0; i < 3; ++i) {
    for (const Shape& shape : random_shapes(random, 0.3 * extent)) {
      if (shape.index() == 5 || random.chance(0.3)) {
        continue;  // a half-space would be near everything
      }
      EnvironmentObject object{"object" + std::to_string(objects.size()),
                               random_pose(random, extent),
                               {{shape, random_pose(random, 0.1 * extent)}}};
      if (random.chance(0.3)) {
        object.shapes.push_back({SphereShape{0.1 * extent}, random_pose(random, 0.2 * extent)});
      }
      objects.push_back(object);
    }
  }
  return objects;
}

/// @param count     of the fibres
/// @param max_points of each
inline FiberAssembly random_fibers(Random& random, double extent, int count = 4,
                                   int max_points = 30) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;
  for (int fiber = 0; fiber < count; ++fiber) {
    Eigen::Vector3d point = random.in_cube(extent);
    for (int i = random.integer(2, max_points); i > 0; --i) {
      points.push_back(point);
      point += random.in_cube(0.1 * extent);
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
    radii.push_back(0.02 * extent * random.uniform(0.0, 1.0));
  }
  return {points, offsets, radii};
}

/// All pairs of a segment and a shape, by the distance in the shape's frame.
inline std::vector<Contact> all_pairs(const FiberAssembly& fibers,
                                      const std::vector<EnvironmentObject>& objects) {
  std::vector<Contact> pairs;
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t p = fibers.offsets()[fiber]; p + 1 < fibers.offsets()[fiber + 1]; ++p) {
      for (std::uint32_t i = 0; i < objects.size(); ++i) {
        for (std::uint32_t j = 0; j < objects[i].shapes.size(); ++j) {
          const Eigen::Isometry3d to_shape =
              (objects[i].pose * objects[i].shapes[j].pose).inverse(Eigen::Isometry);
          const Capsule capsule = fibers.capsule(p);
          const AxisDistance axis = axis_distance(objects[i].shapes[j].shape, to_shape * capsule.p0,
                                                  to_shape * capsule.p1, infinity);
          Contact contact;
          contact.fiber_a = fiber;
          contact.segment_a = p - fibers.offsets()[fiber];
          contact.fiber_b = i;
          contact.segment_b = j;
          contact.distance = axis.distance - capsule.radius;
          contact.point_a = contact.point_b = contact.normal = Eigen::Vector3d::Zero();
          pairs.push_back(contact);
        }
      }
    }
  }
  return pairs;
}

/// Of these pairs what a query is to report.
inline std::vector<Contact> expected(std::vector<Contact> pairs, const QueryOptions& options) {
  const auto beyond = [&](const Contact& pair) { return pair.distance > options.margin; };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), beyond), pairs.end());
  sort_by_distance(pairs);
  const std::size_t most = options.type == QueryType::CLOSEST   ? 1
                           : options.type == QueryType::LIMITED ? options.max_contacts
                                                                : pairs.size();
  pairs.resize(std::min(most, pairs.size()));
  if (options.type == QueryType::FIBER_PAIRS) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Contact> closest;
    for (const Contact& pair : pairs) {
      closest.emplace(std::pair(pair.fiber_a, pair.fiber_b), pair);
    }
    pairs.clear();
    for (const auto& [fibers, pair] : closest) {
      pairs.push_back(pair);
    }
  }
  sort_by_key(pairs);
  return pairs;
}

inline QueryResult ask(const Environment& environment, const FiberAssembly& fibers,
                       const QueryOptions& options, const AllowedPairs& allowed = {}) {
  QueryResult result;
  environment.query(fibers, options, allowed, result);
  return result;
}

}  // namespace fiber::test
