#pragma once

#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/geometry/fiber_graph.hpp"
#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/dense_fibers.hpp"
#include "test/support/hard_scenes.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {

inline int own_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

inline int rank_count() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// Scenes of each family. Every rank computes what one process finds, so that a scene costs as many
/// times more as there are ranks: more than three ranks get fewer scenes, which are others.
inline int scenes_of_a_family() {
  const int ranks = rank_count();
  return rounds(ranks <= 3 ? 6 : std::max(2, 12 / ranks));
}

/// The stream from which the scenes of a family are drawn: that of the family up to three ranks.
inline std::uint64_t stream_of_family(std::size_t family) {
  const int ranks = rank_count();
  return family + (ranks <= 3 ? 0 : 1000 * static_cast<std::uint64_t>(ranks));
}

inline std::uint64_t over_ranks(std::uint64_t value, MPI_Op operation) {
  std::uint64_t result = 0;
  MPI_Allreduce(&value, &result, 1, MPI_UINT64_T, operation, MPI_COMM_WORLD);
  return result;
}

/// What fibres of an assembly are called by all ranks: numbers beyond 32 bits, with gaps.
inline std::uint64_t name_of_fiber(std::uint64_t fiber) {
  return (std::uint64_t{1} << 40U) + 3 * fiber;
}

/// Segments begin … end - 1 of a fibre, for one rank.
struct ScatteredPart {
  std::uint32_t fiber = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  int rank = 0;
};

/// Cuts fibres into parts and gives them to ranks, the same on every rank; some may get nothing.
/// @param cuts for each fibre, at most
inline std::vector<ScatteredPart> scatter(const FiberAssembly& fibers, int cuts, Random& random) {
  const int first = random.chance(0.3) ? random.integer(0, rank_count() - 1) : 0;
  std::vector<ScatteredPart> parts;
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const auto count = static_cast<int>(fibers.offsets()[fiber + 1] - fibers.offsets()[fiber] - 1);
    std::vector<int> places{0, count};
    for (int cut = random.integer(0, cuts); cut > 0; --cut) {
      places.push_back(random.integer(0, count));
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      parts.push_back({fiber, static_cast<std::uint32_t>(places[i]),
                       static_cast<std::uint32_t>(places[i + 1]),
                       random.integer(first, rank_count() - 1)});
    }
  }
  for (std::size_t i = parts.size(); i > 1; --i) {
    std::swap(parts[i - 1],
              parts[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  }
  return parts;
}

/// The parts that a rank gets.
inline DistributedFibers scattered_to(int rank, const FiberAssembly& fibers,
                                      const std::vector<ScatteredPart>& scattered) {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> radii;
  std::vector<std::uint32_t> offsets{0};
  DistributedFibers mine;
  FiberTopology topology = fibers.topology();
  if (!topology.joints.empty()) {
    fibers.graph()->repeat_first_points(topology.joints);
  }
  const auto radius_of = [&](std::uint32_t fiber, std::uint32_t point) {
    const std::vector<double>& all = fibers.radii();
    return all.size() == 1 ? all[0] : all.size() == fibers.fiber_count() ? all[fiber] : all[point];
  };
  for (const ScatteredPart& part : scattered) {
    if (part.rank == rank) {
      const std::uint32_t start = fibers.offsets()[part.fiber];
      for (std::uint32_t p = start + part.begin; p <= start + part.end; ++p) {
        points.push_back(fibers.points()[p]);
        radii.push_back(radius_of(part.fiber, p));
        if (!topology.joints.empty()) {
          mine.topology.joints.push_back(topology.joints[p]);
        }
      }
      if (!topology.closed.empty()) {
        mine.topology.closed.push_back(topology.closed[part.fiber]);
      }
      offsets.push_back(static_cast<std::uint32_t>(points.size()));
      mine.names.push_back({name_of_fiber(part.fiber), part.begin});
    }
  }
  if (!points.empty()) {
    mine.parts = FiberAssembly(std::move(points), std::move(offsets), std::move(radii));
    mine.topology.joint_tolerance = topology.joint_tolerance;
  }
  return mine;
}

/// Moves parts of these fibres to where the fibres are.
inline void follow(const FiberAssembly& fibers, DistributedFibers& mine) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t part = 0; part < mine.names.size(); ++part) {
    const std::uint64_t fiber = (mine.names[part].fiber - name_of_fiber(0)) / 3;
    const auto begin = fibers.points().begin() + fibers.offsets()[fiber] +
                       static_cast<std::ptrdiff_t>(mine.names[part].first_segment);
    points.insert(points.end(), begin,
                  begin + (mine.parts.offsets()[part + 1] - mine.parts.offsets()[part]));
  }
  mine.parts.update_points(points);
}

inline std::uint64_t bits_of(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  return bits;
}

inline bool same_bits(double x, double y) { return bits_of(x) == bits_of(y); }
inline bool same_bits(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  return same_bits(x.x(), y.x()) && same_bits(x.y(), y.y()) && same_bits(x.z(), y.z());
}

inline bool same_bits(const DistributedContact& x, const Contact& y) {
  return x.fiber_a == name_of_fiber(y.fiber_a) && x.segment_a == y.segment_a &&
         x.fiber_b == name_of_fiber(y.fiber_b) && x.segment_b == y.segment_b &&
         same_bits(x.s, y.s) && same_bits(x.t, y.t) && same_bits(x.distance, y.distance) &&
         same_bits(x.lower, y.lower) && same_bits(x.upper, y.upper) &&
         same_bits(x.point_a, y.point_a) && same_bits(x.point_b, y.point_b) &&
         same_bits(x.normal, y.normal);
}

inline std::string names_in(const DistributedContact& x) {
  return "(" + std::to_string(x.fiber_a) + ", " + std::to_string(x.segment_a) + ", " +
         std::to_string(x.fiber_b) + ", " + std::to_string(x.segment_b) + ")";
}

inline testing::AssertionResult same_contacts(const std::vector<DistributedContact>& found,
                                              const std::vector<Contact>& expected) {
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    const Contact& contact = expected[i];
    if (!same_bits(found[i], contact)) {
      return testing::AssertionFailure()
             << "contact " << i << " is " << names_in(found[i]) << " at " << found[i].distance
             << ", expected (" << name_of_fiber(contact.fiber_a) << ", " << contact.segment_a
             << ", " << name_of_fiber(contact.fiber_b) << ", " << contact.segment_b << ") at "
             << contact.distance;
    }
  }
  if (found.size() != expected.size()) {
    return testing::AssertionFailure() << found.size() << " contacts, expected " << expected.size();
  }
  return testing::AssertionSuccess();
}

/// Whether the ranks have found what one process finds, bit for bit. Rank 0 has the contacts, and
/// tells the others: a test that one rank leaves, all must.
inline testing::AssertionResult same_as_one_process(const DistributedResult& all,
                                                    const std::vector<Contact>& expected) {
  testing::AssertionResult result = testing::AssertionSuccess();
  if (own_rank() == 0) {
    result = same_contacts(all.contacts, expected);
  }
  int is_same = result ? 1 : 0;
  MPI_Bcast(&is_same, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return own_rank() == 0 || is_same != 0 ? result : testing::AssertionFailure() << "see rank 0";
}

/// Of one thread: ranks share the machine.
inline EngineOptions one_thread() {
  EngineOptions options;
  options.threads = 1;
  return options;
}

/// The ranks' engine, which has these fibres, scattered at random.
struct ScatteredEngine : DistributedEngine {
  ScatteredEngine(const FiberAssembly& fibers, Random& random)
      : DistributedEngine(MPI_COMM_WORLD, one_thread()) {
    const DistributedFibers mine = scattered_to(own_rank(), fibers, scatter(fibers, 2, random));
    update(mine.parts, mine.names);
  }
};

/// Assemblies of all kinds, for whatever is to be the same on any number of ranks.
inline std::vector<AssemblyFamily> rank_families() {
  std::vector<AssemblyFamily> all = assembly_families();
  for (const std::vector<AssemblyFamily>& more : {dense_families(), hard_scenes()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

/// One fibre that winds up to a ball, and comes by each place many times.
inline FiberAssembly ball_of_wool(Random& random, int segments, double min_turns,
                                  double min_radius) {
  std::vector<Eigen::Vector3d> points;
  const double turns = random.uniform(min_turns, 1.5 * min_turns);
  for (int i = 0; i <= segments; ++i) {
    const double x = static_cast<double>(i) / segments;
    const double around = 2.0 * pi * turns * x;
    const double out = 0.1 * std::sin(pi * x * 7.0);
    points.emplace_back(out * std::cos(around), out * std::sin(around),
                        0.1 * std::cos(pi * x * 7.0));
  }
  return as_fibers({points}, random.uniform(min_radius, 10.0 * min_radius));
}

/// What the ranks find together, on rank 0.
inline DistributedResult answer(DistributedEngine& engine, const QueryOptions& options) {
  DistributedResult result;
  engine.query(options, result);
  return gather(MPI_COMM_WORLD, result);
}

/// A limit of pairs, and then a deadline that nothing can keep: pairs are missing, and that is
/// told.
/// @param all contacts that there are
inline void expect_limits_leave_out(DistributedEngine& engine, QueryOptions options,
                                    std::size_t all) {
  options.pair_limit = 100;
  DistributedResult found = answer(engine, options);
  EXPECT_FALSE(found.complete);
  EXPECT_TRUE(found.limit_reached);
  EXPECT_LT(found.contacts.size(), all);
  options.pair_limit = 0;
  options.deadline = 1e-9;
  found = answer(engine, options);
  EXPECT_FALSE(found.complete);
  EXPECT_LT(found.contacts.size(), all);
}

}  // namespace fiber::test
