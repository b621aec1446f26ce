// What ranks write together they read together, whatever the number of either.
#include "fiber_proximity/mpi/distributed_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "src/io/radii.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/gather_fibers.hpp"
#include "src/mpi/hdf5_file.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/mpi/shared_folder.hpp"
#include "test/support/joined_fibers.hpp"
#include "test/support/random.hpp"

namespace fiber {
namespace {

/// All that is known of a segment: fibre and index, both points, and the radius.
using SegmentFacts = std::array<double, 9>;

/// Of all ranks, in the order of fibres.
std::vector<SegmentFacts> segments_of(const DistributedFibers& fibers) {
  const Communicator ranks(MPI_COMM_WORLD);
  std::vector<SegmentFacts> mine;
  for (std::size_t part = 0; part < fibers.names.size(); ++part) {
    const FiberPart& name = fibers.names[part];
    const std::uint32_t begin = fibers.parts.offsets()[part];
    for (std::uint32_t p = begin; p + 1 < fibers.parts.offsets()[part + 1]; ++p) {
      const Capsule segment = fibers.parts.capsule(p);
      mine.push_back({static_cast<double>(name.fiber),
                      static_cast<double>(name.first_segment + p - begin), segment.p0[0],
                      segment.p0[1], segment.p0[2], segment.p1[0], segment.p1[1], segment.p1[2],
                      segment.radius});
    }
  }
  std::vector<SegmentFacts> all =
      joined(ranks.exchange(PerRank<SegmentFacts>(static_cast<std::size_t>(ranks.size()), mine)));
  std::sort(all.begin(), all.end());
  return all;
}

DistributedFibers random_parts(test::Random& random, const FiberAssembly& fibers, int cuts) {
  return test::scattered_to(test::own_rank(), fibers, test::scatter(fibers, cuts, random));
}

/// Fibres of few segments or many, with radii per point, per fibre or one for all.
FiberAssembly random_assembly(test::Random& random) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  const int count = random.integer(1, 12);
  for (int fiber = 0; fiber < count; ++fiber) {
    for (int left = random.integer(2, random.chance(0.2) ? 300 : 6); left > 0; --left) {
      points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  std::vector<double> radii(random.chance(0.5)   ? points.size()
                            : random.chance(0.5) ? offsets.size() - 1
                                                 : 1);
  for (double& radius : radii) {
    radius = random.uniform(0, 0.1);
  }
  return {std::move(points), std::move(offsets), std::move(radii)};
}

std::int64_t version_of(const std::string& path) {
  const Communicator ranks(MPI_COMM_WORLD);
  return read_number(open_parallel_file(ranks, path).get(), "version").value_or(0);
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(DistributedFiles, FibersComeBackAsTheyWere) {
  const test::SharedFolder folder;
  test::Random random(21);
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    const FiberAssembly assembly = random_assembly(random);
    const DistributedFibers written = random_parts(random, assembly, round % 4);
    const std::string path = folder / "fibers.h5";
    DistributedFiberWriter writer(MPI_COMM_WORLD, path);
    writer.write(0, written);
    writer.finish();
    DistributedFibers read;
    const DistributedFiberReader reader(MPI_COMM_WORLD, path);
    ASSERT_EQ(reader.frame_count(), 1u);
    ASSERT_FALSE(reader.has_frames());
    ASSERT_EQ(reader.read(0, read), 0);
    ASSERT_EQ(segments_of(read), segments_of(written));
    // About equal shares.
    const std::size_t all = assembly.segment_count();
    const auto size = static_cast<std::size_t>(test::rank_count());
    ASSERT_GE(read.parts.segment_count(), all / size);
    ASSERT_LE(read.parts.segment_count(), all / size + 1);
  }
}

/// The fibres of all ranks, whole, on rank 0; none on the others.
FiberAssembly whole_on_root(const DistributedFibers& fibers) {
  return gather_fibers(Communicator(MPI_COMM_WORLD), fibers).fibers;
}

TEST(DistributedFiles, ClosedAndJoinedFibersComeBackAsTheyWere) {
  const test::SharedFolder folder;
  test::Random random(24);
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    test::JoinedFibers fibers = test::random_joined_fibers(random);
    if (random.chance(0.5)) {
      fibers.topology.joint_tolerance = 0.1;
    }
    const FiberAssembly assembly = fibers.assembly();
    const std::string path = folder / "fibers.h5";
    DistributedFiberWriter writer(MPI_COMM_WORLD, path);
    writer.write(0, random_parts(random, assembly, round % 4));
    writer.finish();
    ASSERT_EQ(version_of(path), 2);
    DistributedFibers read;
    DistributedFiberReader(MPI_COMM_WORLD, path).read(0, read);
    const FiberAssembly whole = whole_on_root(read);
    const bool is_root = test::own_rank() == 0;
    EXPECT_TRUE(!is_root || whole.has_topology_of(assembly));
    EXPECT_TRUE(!is_root || whole.given_points() == assembly.given_points());
    EXPECT_TRUE(!is_root || whole.topology().joint_tolerance == fibers.topology.joint_tolerance);
    for (std::size_t fiber = 0; is_root && fiber < assembly.fiber_count(); ++fiber) {
      for (std::uint32_t p = assembly.offsets()[fiber]; p < assembly.offsets()[fiber + 1]; ++p) {
        EXPECT_EQ(whole.radius_at(fiber, p), assembly.radius_at(fiber, p));
      }
    }
  }
  DistributedFiberWriter writer(MPI_COMM_WORLD, folder / "chains.h5");
  writer.write(0, random_parts(random, random_assembly(random), 2));
  writer.finish();
  EXPECT_EQ(version_of(folder / "chains.h5"), 1) << "for programs that know of no joints";
}

TEST(DistributedFiles, NamesComeBackOnAllRanks) {
  const test::SharedFolder folder;
  test::Random random(23);
  const FiberAssembly assembly = random_assembly(random);
  DistributedFibers written = random_parts(random, assembly, 2);
  for (FiberPart& part : written.names) {  // names are found by numbers from 0 on
    part.fiber = (part.fiber - test::name_of_fiber(0)) / 3;
  }
  std::vector<std::string> names;
  for (std::size_t fiber = 0; fiber < assembly.fiber_count(); ++fiber) {
    names.push_back("rope, no. " + std::to_string(assembly.fiber_count() - fiber) + "\xFF");
  }
  DistributedFileOptions options;
  options.has_frames = true;
  DistributedFiberWriter writer(MPI_COMM_WORLD, folder / "fibers.h5", options);
  writer.write(3, written);
  written.fiber_names = FiberNames(names);
  writer.write(4, written);
  names.front() = "one";
  written.fiber_names = FiberNames({"one"});
  if (names.size() > 1) {
    EXPECT_THROW(writer.write(5, written), std::invalid_argument);
  }
  written.fiber_names = FiberNames(names);
  writer.write(6, written);
  writer.finish();
  const DistributedFiberReader reader(MPI_COMM_WORLD, folder / "fibers.h5");
  DistributedFibers read;
  EXPECT_EQ(reader.read(2, read), 6);
  EXPECT_EQ(read.fiber_names.list(names.size()), names);
  EXPECT_EQ(reader.read(1, read), 4);
  names.front() = "rope, no. " + std::to_string(names.size()) + "\xFF";
  EXPECT_EQ(read.fiber_names.list(names.size()), names);
  EXPECT_EQ(read.fiber_names.size(), assembly.fiber_count());
  EXPECT_EQ(segments_of(read), segments_of(written));
  EXPECT_EQ(reader.read(0, read), 3);
  EXPECT_TRUE(read.fiber_names.are_indices());
}

TEST(DistributedFiles, WholeFibersMakeTheSameFileOfAnyRanks) {
  const test::SharedFolder folder;
  test::Random random(22);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE(round);
    const FiberAssembly assembly =
        round % 2 == 0 ? random_assembly(random) : test::random_joined_fibers(random).assembly();
    // In the order of fibres, cut where the random numbers say.
    std::vector<test::ScatteredPart> parts;
    const auto ranks = static_cast<std::uint32_t>(test::rank_count());
    for (std::uint32_t fiber = 0; fiber < assembly.fiber_count(); ++fiber) {
      const std::uint32_t count = assembly.offsets()[fiber + 1] - assembly.offsets()[fiber] - 1;
      const std::uint32_t rank = fiber * ranks / static_cast<std::uint32_t>(assembly.fiber_count());
      const auto cut = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(count)));
      const std::uint32_t next_fiber =
          (fiber + 1) * ranks / static_cast<std::uint32_t>(assembly.fiber_count());
      const std::uint32_t after = std::min(next_fiber, ranks - 1);
      if (cut > 0) {
        parts.push_back({fiber, 0, cut, static_cast<int>(rank)});
      }
      if (cut < count) {
        parts.push_back({fiber, cut, count, static_cast<int>(after)});
      }
    }
    DistributedFibers mine = test::scattered_to(test::own_rank(), assembly, parts);
    DistributedFiberWriter cut(MPI_COMM_WORLD, folder / "cut.h5");
    cut.write(0, mine);
    cut.finish();
    for (test::ScatteredPart& part : parts) {
      part.rank = 0;
    }
    mine = test::scattered_to(test::own_rank(), assembly, parts);
    DistributedFiberWriter whole(MPI_COMM_WORLD, folder / "whole.h5");
    whole.write(0, mine);
    whole.finish();
    ASSERT_TRUE(bytes_of(folder / "cut.h5") == bytes_of(folder / "whole.h5"));
    ASSERT_FALSE(std::filesystem::exists(folder / "whole.h5.part"));
  }
}

TEST(DistributedFiles, FramesComeBackWithTheirNumbers) {
  const test::SharedFolder folder;
  test::Random random(23);
  const FiberAssembly assembly = random_assembly(random);
  const std::vector<std::int64_t> numbers{5, -3, 12};
  DistributedFileOptions options;
  options.has_frames = true;
  options.run = "the first";
  std::vector<std::vector<SegmentFacts>> expected;
  {
    DistributedFiberWriter writer(MPI_COMM_WORLD, folder / "moving.h5", options);
    for (const std::int64_t number : numbers) {
      FiberAssembly moved = assembly;
      std::vector<Eigen::Vector3d> points = assembly.points();
      for (Eigen::Vector3d& point : points) {
        point.x() += static_cast<double>(number);
      }
      moved.update_points(points);
      const DistributedFibers fibers = random_parts(random, moved, 2);
      writer.write(number, fibers);
      expected.push_back(segments_of(fibers));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "moving.h5"));
    EXPECT_THROW(writer.write(5, {}), std::invalid_argument);
    writer.finish();
  }
  const DistributedFiberReader reader(MPI_COMM_WORLD, folder / "moving.h5");
  ASSERT_TRUE(reader.has_frames());
  ASSERT_EQ(reader.frame_count(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    DistributedFibers fibers;
    EXPECT_EQ(reader.read(i, fibers), numbers[i]);
    EXPECT_EQ(segments_of(fibers), expected[i]);
  }
}

}  // namespace
}  // namespace fiber
