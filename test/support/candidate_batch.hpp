#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// A cable that is thick for its points, and more or less coiled.
inline FiberAssembly coil(Random& random) {
  const double radius = random.uniform(0.005, 0.06);
  const double bend = random.uniform(0.0, 1.0);
  Eigen::Vector3d point = random.in_cube();
  Eigen::Vector3d heading = random.direction();
  const Eigen::Vector3d turn = random.direction();
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 25; ++k) {
    points.push_back(point);
    point += random.uniform(0.02, 0.06) * heading;
    heading = (heading + bend * turn.cross(heading) + 0.1 * random.direction()).normalized();
  }
  return as_fibers({points}, radius);
}

/// Candidates, assemblies of their own, and fibres that stand still, as DeviceProximity takes them.
struct CandidateBatch {
  std::vector<FiberAssembly> candidates;
  FiberAssembly still;

  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;
  std::vector<std::uint32_t> begins{0};
  std::vector<std::uint32_t> first_points;

  CandidateBatch(std::vector<FiberAssembly> all, FiberAssembly standing)
      : candidates(std::move(all)), still(std::move(standing)) {
    const auto has_many = [](const FiberAssembly& fibers) {
      return fibers.radius_per() == RadiusPer::POINT;
    };
    const bool per_point =
        has_many(still) || std::any_of(candidates.begin(), candidates.end(), has_many);
    for (const FiberAssembly& candidate : candidates) {
      first_points.push_back(static_cast<std::uint32_t>(points.size()));
      add(candidate, per_point);
      begins.push_back(static_cast<std::uint32_t>(offsets.size()) - 1);
    }
    first_points.push_back(static_cast<std::uint32_t>(points.size()));
    add(still, per_point);
    if (radii.empty()) {
      radii = {0.0};
    }
  }

  std::unique_ptr<DeviceProximity> make() const {
    return std::make_unique<DeviceProximity>(make_test_device(), offsets, radii, begins);
  }

 private:
  void add(const FiberAssembly& fibers, bool per_point) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), fibers.points().begin(), fibers.points().end());
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      const std::uint32_t begin = fibers.offsets()[fiber];
      const std::uint32_t end = fibers.offsets()[fiber + 1];
      offsets.push_back(first + end);
      for (std::uint32_t point = begin; point < (per_point ? end : begin + 1); ++point) {
        radii.push_back(fibers.radius_at(fiber, point));
      }
    }
  }
};

/// What DeviceProximity tells of a contact.
struct FoundContact {
  std::uint32_t a;
  std::uint32_t b;
  double s;
  double t;
  double distance;

  bool operator==(const FoundContact& other) const {
    return std::tie(a, b, s, t, distance) ==
           std::tie(other.a, other.b, other.s, other.t, other.distance);
  }
};

/// What brute force finds of a candidate that is alone with the fibres that stand still.
inline std::vector<FoundContact> contacts_of(const CandidateBatch& batch, std::size_t candidate,
                                             const DeviceProximity::Options& options) {
  const FiberAssembly& fibers = batch.candidates[candidate];
  QueryOptions same = within(options.margin);
  same.neighbour_skip = options.neighbour_skip;
  same.pairing = options.pairing;
  std::vector<FoundContact> all;
  const auto first_of = [](const FiberAssembly& of, std::uint32_t fiber, std::uint32_t segment) {
    return of.offsets()[fiber] + segment;
  };
  const auto add = [&](const Contact& contact, const FiberAssembly& other, std::uint32_t first) {
    all.push_back(
        {batch.first_points[candidate] + first_of(fibers, contact.fiber_a, contact.segment_a),
         first + first_of(other, contact.fiber_b, contact.segment_b), contact.s, contact.t,
         contact.distance});
  };
  if (options.with_itself) {
    for (const Contact& contact : brute_force(fibers, same).contacts) {
      add(contact, fibers, batch.first_points[candidate]);
    }
  }
  for (const Contact& contact : brute_force(fibers, batch.still, same).contacts) {
    add(contact, batch.still, batch.first_points.back());
  }
  std::sort(all.begin(), all.end(), [](const FoundContact& x, const FoundContact& y) {
    return std::tie(x.a, x.b) < std::tie(y.a, y.b);
  });
  return all;
}

}  // namespace fiber::test
