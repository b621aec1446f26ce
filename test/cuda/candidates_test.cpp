// Candidates of planners, thousands in one tree: each beside the fibres that it is alone with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/cuda/device.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/candidate_batch.hpp"
#include "test/support/contacts.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/error_of.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Options = DeviceProximity::Options;

/// @param found arrays of contacts on the host
/// @return how many there are
template <class Arrays>
std::size_t expect_candidates(const Arrays& found, std::size_t count, const CandidateBatch& batch,
                              const Options& options) {
  std::size_t next = 0;
  for (std::size_t candidate = 0; candidate < batch.candidates.size(); ++candidate) {
    EXPECT_EQ(found.candidate_begins[candidate], next) << "candidate " << candidate;
    for (const FoundContact& contact : contacts_of(batch, candidate, options)) {
      const FoundContact here = next < count
                                    ? FoundContact{found.a[next], found.b[next], found.s[next],
                                                   found.t[next], found.distance[next]}
                                    : FoundContact{};
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
std::size_t expect_touching(const DeviceProximity& device, const CandidateBatch& batch,
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
CandidateBatch some_of(const AssemblyFamily& family, Random& random) {
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

Options some_options(const CandidateBatch& batch, Random& random) {
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
      const CandidateBatch batch = some_of(family, random);
      const std::unique_ptr<DeviceProximity> device = batch.make();
      ASSERT_EQ(device->candidate_count(), batch.candidates.size());
      device->update_from_host(batch.points);
      Options options = some_options(batch, random);
      const DeviceProximity::Contacts arrays = device->query_to_host(options);
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
  EXPECT_GT(contacts, 1000U / rounds_less);
  EXPECT_GT(touching, 100U / rounds_less);
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
  const CandidateBatch batch(candidates, walks(random, 10, 20, 0.1, 0.005));
  const std::unique_ptr<DeviceProximity> device = batch.make();
  for (int frame = 0; frame < 2; ++frame) {
    device->update_from_host(batch.points);
    Options options{0.01};
    const DeviceProximity::Contacts arrays = device->query_to_host(options);
    EXPECT_GT(expect_candidates(arrays, arrays.count, batch, options), candidates.size() / 6);
    options.neighbour_skip.reset();
    const std::size_t touching = expect_touching(*device, batch, options);
    EXPECT_GT(touching, candidates.size() / 20);
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
    const CandidateBatch batch(candidates,
                               has_still ? walks(random, 2, 40, 0.1, 0.01) : FiberAssembly());
    const std::unique_ptr<DeviceProximity> device = batch.make();
    device->update_from_host(batch.points);
    const Options options{0.02, 1};
    const DeviceProximity::Contacts arrays = device->query_to_host(options);
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
      candidates.push_back(coil(random));
    }
    const CandidateBatch batch(candidates, FiberAssembly());
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
