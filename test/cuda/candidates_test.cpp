// Candidates of planners, thousands in one tree: each beside the fibres that it is alone with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/cuda/device.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/error_of.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Options = DeviceProximity::Options;

/// Candidates, assemblies of their own, and fibres that stand still, as DeviceProximity takes them.
struct Batch {
  std::vector<FiberAssembly> candidates;
  FiberAssembly still;

  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;
  std::vector<std::uint32_t> begins{0};
  std::vector<std::uint32_t> first_points;

  Batch(std::vector<FiberAssembly> all, FiberAssembly standing)
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

struct Found {
  std::uint32_t a;
  std::uint32_t b;
  double s;
  double t;
  double distance;

  bool operator==(const Found& other) const {
    return std::tie(a, b, s, t, distance) ==
           std::tie(other.a, other.b, other.s, other.t, other.distance);
  }
};

/// What brute force finds of a candidate that is alone with the fibres that stand still.
std::vector<Found> expected_of(const Batch& batch, std::size_t candidate, const Options& options) {
  const FiberAssembly& fibers = batch.candidates[candidate];
  QueryOptions same = within(options.margin);
  same.neighbour_skip = options.neighbour_skip;
  same.pairing = options.pairing;
  std::vector<Found> all;
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
  std::sort(all.begin(), all.end(),
            [](const Found& x, const Found& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
  return all;
}

/// @param found arrays of contacts on the host
/// @return how many there are
template <class Arrays>
std::size_t expect_candidates(const Arrays& found, std::size_t count, const Batch& batch,
                              const Options& options) {
  std::size_t next = 0;
  for (std::size_t candidate = 0; candidate < batch.candidates.size(); ++candidate) {
    EXPECT_EQ(found.candidate_begins[candidate], next) << "candidate " << candidate;
    for (const Found& contact : expected_of(batch, candidate, options)) {
      const Found here = next < count ? Found{found.a[next], found.b[next], found.s[next],
                                              found.t[next], found.distance[next]}
                                      : Found{};
      EXPECT_TRUE(here == contact) << "candidate " << candidate << ", contact " << next;
      if (testing::Test::HasFailure()) {
        return 0;
      }
      ++next;
    }
  }
  EXPECT_EQ(found.candidate_begins[batch.candidates.size()], next);
  EXPECT_EQ(count, next);
  return next;
}

/// Whether candidates touch, as check_fibers() says it.
/// @return how many do
std::size_t expect_touching(const DeviceProximity& device, const Batch& batch,
                            const Options& options) {
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree");
  engine->update(batch.still);
  Surroundings surroundings;
  surroundings.fibers = engine.get();
  surroundings.self = options.with_itself;
  QueryOptions same = within(options.margin, QueryType::FIRST);
  same.neighbour_skip = options.neighbour_skip;
  same.pairing = options.pairing;
  std::vector<FiberCheck> checks;
  check_fibers(batch.candidates, surroundings, same, checks);
  std::vector<std::uint8_t> touching(1, 2);
  device.check_candidates(options, touching);
  EXPECT_EQ(touching.size(), batch.candidates.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    EXPECT_TRUE(checks[i].is_decided());
    EXPECT_EQ(touching[i], checks[i].has_contact() ? 1 : 0) << "candidate " << i;
    count += touching[i];
  }
  return count;
}

/// A few of a family, some of them twice and some without any fibre.
Batch some_of(const AssemblyFamily& family, Random& random) {
  std::vector<FiberAssembly> candidates;
  const int count = random.integer(0, 8);
  for (int i = 0; i < count; ++i) {
    if (random.chance(0.2)) {
      candidates.emplace_back();
    } else if (!candidates.empty() && random.chance(0.3)) {
      candidates.push_back(candidates.back());
    } else {
      candidates.push_back(family.make(random));
    }
  }
  return {candidates, random.chance(0.3) ? FiberAssembly() : family.make(random)};
}

Options some_options(const Batch& batch, Random& random) {
  double extent = 0.0;
  for (const FiberAssembly& candidate : batch.candidates) {
    extent = std::max(extent, candidate.point_count() == 0 ? 0.0 : extent_of(candidate));
  }
  Options options;
  options.margin = random.chance(0.5) ? 0.0 : 0.05 * extent;
  options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 3));
  options.pairing = static_cast<Pairing>(random.integer(0, 2));
  options.with_itself = random.chance(0.8);
  return options;
}

TEST(Candidates, OfAllFamiliesAreAlone) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t contacts = 0;
  std::size_t touching = 0;
  for (int round = 0; round < rounds(10); ++round) {
    for (const AssemblyFamily& family : assembly_families()) {
      SCOPED_TRACE(family.name);
      const Batch batch = some_of(family, random);
      const std::unique_ptr<DeviceProximity> device = batch.make();
      ASSERT_EQ(device->candidate_count(), batch.candidates.size());
      device->update_from_host(batch.points);
      Options options = some_options(batch, random);
      const DeviceProximity::HostArrays arrays = device->query_to_host(options);
      contacts += expect_candidates(arrays, arrays.count, batch, options);
      DeviceProximity::HostContacts copy;
      device->copy_to_host(device->query(options), copy);
      expect_candidates(copy, copy.a.size(), batch, options);
      touching += expect_touching(*device, batch, options);
      options.neighbour_skip.reset();
      touching += expect_touching(*device, batch, options);
      if (HasFailure()) {
        return;
      }
    }
  }
  EXPECT_GT(contacts, 1000U);
  EXPECT_GT(touching, 100U);
}

/// Far more than a leaf, or a node, has; all in one place, and some of them the same.
TEST(Candidates, ThousandsThatOverlapAreAlone) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::vector<FiberAssembly> candidates;
  constexpr int count = rounds_less > 1 ? 300 : 3000;
  for (int i = 0; i < count; ++i) {
    const bool again = random.chance(0.1) && !candidates.empty();
    candidates.push_back(again ? candidates.back()
                               : walks(random, random.integer(1, 3), random.integer(1, 12), 0.2,
                                       random.uniform(0.0, 0.05)));
  }
  const Batch batch(candidates, walks(random, 10, 20, 0.1, 0.005));
  const std::unique_ptr<DeviceProximity> device = batch.make();
  for (int frame = 0; frame < 2; ++frame) {
    device->update_from_host(batch.points);
    Options options{0.01};
    const DeviceProximity::HostArrays arrays = device->query_to_host(options);
    EXPECT_GT(expect_candidates(arrays, arrays.count, batch, options), 1000U);
    options.neighbour_skip.reset();
    const std::size_t touching = expect_touching(*device, batch, options);
    EXPECT_GT(touching, candidates.size() / 10);
    EXPECT_LT(touching, candidates.size() * 9 / 10);
  }
}

/// One that is more than all others together, and those of a single segment.
TEST(Candidates, OfAnySizeAreAlone) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::vector<FiberAssembly> candidates;
  for (int i = 0; i < 40; ++i) {
    candidates.push_back(walks(random, 1, 1, 0.1, 0.02));
  }
  candidates.push_back(walks(random, 30, rounds_less > 1 ? 10 : 60, 0.05, 0.05));
  candidates.push_back(walks(random, 1, 1, 0.1, 0.02));
  for (const bool has_still : {false, true}) {
    const Batch batch(candidates, has_still ? walks(random, 2, 40, 0.1, 0.01) : FiberAssembly());
    const std::unique_ptr<DeviceProximity> device = batch.make();
    device->update_from_host(batch.points);
    const Options options{0.02, 1};
    const DeviceProximity::HostArrays arrays = device->query_to_host(options);
    EXPECT_GT(expect_candidates(arrays, arrays.count, batch, options), 100U);
    expect_touching(*device, batch, options);
  }
}

/// Cables so thick that each touches what follows its neighbours, some of them coiled: only a loop
/// makes that a contact.
TEST(Candidates, NeedLoopsWhereTheRuleSaysSo) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t touching = 0;
  std::size_t count = 0;
  std::size_t without_rule = 0;
  for (int round = 0; round < rounds(20); ++round) {
    std::vector<FiberAssembly> candidates;
    for (int i = 0; i < 30; ++i) {
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
      candidates.push_back(as_fibers({points}, radius));
    }
    const Batch batch(candidates, FiberAssembly());
    const std::unique_ptr<DeviceProximity> device = batch.make();
    device->update_from_host(batch.points);
    Options options{random.chance(0.5) ? 0.0 : 0.02, std::nullopt};
    touching += expect_touching(*device, batch, options);
    count += candidates.size();
    options.neighbour_skip = 1;
    without_rule += expect_touching(*device, batch, options);
  }
  EXPECT_GT(touching, count / 10);
  EXPECT_LT(touching, count * 9 / 10);
  EXPECT_GT(without_rule, touching);
}

TEST(Candidates, AreRefusedByName) {
  const auto refusal_of = [](std::vector<std::uint32_t> candidates) {
    return error_of([&] { DeviceProximity(make_test_device(), {0, 2, 4, 6}, {0.1}, candidates); });
  };
  const std::string allowed =
      ", they must begin with 0, not decrease, and be at most the number of fibres, 3";
  EXPECT_EQ(refusal_of({}),
            "candidates has no values, it needs at least 1: where what stands still begins");
  EXPECT_EQ(refusal_of({1, 2}), "candidates[0] is 1" + allowed);
  EXPECT_EQ(refusal_of({0, 2, 1}), "candidates[2] is 1" + allowed);
  EXPECT_EQ(refusal_of({0, 2, 4}), "candidates[2] is 4" + allowed);

  DeviceProximity device(make_test_device(), {0, 2, 4, 6}, {0.1}, {0, 1, 2});
  std::vector<std::uint8_t> touching;
  EXPECT_THROW(device.check_candidates({}, touching), std::logic_error);
  std::vector<Eigen::Vector3d> points(6, Eigen::Vector3d::Zero());
  points[3].z() = std::numeric_limits<double>::infinity();
  const std::string finite = " is inf, coordinates must be finite and at most 1e150 m in magnitude";
  EXPECT_EQ(error_of([&] { device.update_from_host(points); }),
            "candidate 1, its point 1: z" + finite);
  const std::unique_ptr<Device> memory = make_test_device();
  const std::shared_ptr<void> there =
      memory->make_array(points.data(), points.size() * sizeof(Eigen::Vector3d));
  EXPECT_EQ(error_of([&] { device.update(static_cast<const double*>(there.get())); }),
            "candidate 1, its point 1: z" + finite);
  EXPECT_THROW(device.check_candidates({}, touching), std::logic_error);
  std::swap(points[3], points[5]);
  EXPECT_EQ(error_of([&] { device.update_from_host(points); }), "point 5: z" + finite);
  points[5].z() = 1.0;
  device.update_from_host(points);
  device.check_candidates({}, touching);
  EXPECT_EQ(touching, (std::vector<std::uint8_t>{1, 1}));
  EXPECT_EQ(error_of([&] { device.check_candidates({-1.0}, touching); }),
            "margin is -1.000000 m, it must be finite and not negative");
  EXPECT_NE(error_of([&] {
              device.query({0.0, std::nullopt});
            }).find("check_candidates()"),
            std::string::npos);
  const DeviceProximity without(make_test_device(), {0, 2, 4, 6}, {0.1});
  EXPECT_EQ(without.candidate_count(), 0U);
  EXPECT_THROW(without.check_candidates({}, touching), std::logic_error);
}

}  // namespace
}  // namespace fiber::test
