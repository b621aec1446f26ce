// Contacts sorted over the ranks, and their files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/mpi/shared_folder.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

/// Contacts with keys of their own, scattered to the ranks; on all of them the same of all.
struct ScatteredContacts {
  std::vector<DistributedContact> all;  // sorted
  DistributedResult mine;
};

ScatteredContacts scatter_contacts(int count, double share_of_first, Random& random) {
  ScatteredContacts scattered;
  std::vector<int> ranks;
  for (int i = 0; i < count; ++i) {
    DistributedContact contact;
    contact.fiber_a = (std::uint64_t{1} << 40U) + static_cast<std::uint64_t>(random.integer(0, 5));
    contact.segment_a = static_cast<std::uint64_t>(random.integer(0, 9));
    contact.fiber_b = contact.fiber_a + static_cast<std::uint64_t>(random.integer(0, 2));
    contact.segment_b = static_cast<std::uint64_t>(i);
    contact.s = random.uniform(0, 1);
    contact.t = random.uniform(0, 1);
    contact.distance = random.uniform(-1, 1);
    contact.lower = contact.distance - 1e-9;
    contact.upper = contact.distance + 1e-9;
    contact.point_a = Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.5);
    contact.point_b = Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), -0.5);
    contact.normal = Eigen::Vector3d::UnitZ();
    const bool is_first = random.chance(share_of_first);
    if (const int rank = random.integer(0, rank_count() - 1); own_rank() == (is_first ? 0 : rank)) {
      scattered.mine.contacts.push_back(contact);
    }
    scattered.all.push_back(contact);
  }
  std::sort(
      scattered.all.begin(), scattered.all.end(),
      [](const DistributedContact& x, const DistributedContact& y) { return x.key() < y.key(); });
  return scattered;
}

bool are_same(const DistributedContact& x, const DistributedContact& y) {
  return x.key() == y.key() && x.s == y.s && x.t == y.t && x.distance == y.distance &&
         x.lower == y.lower && x.upper == y.upper && x.point_a == y.point_a &&
         x.point_b == y.point_b && x.normal == y.normal;
}

/// How many contacts each rank has.
std::vector<std::size_t> counts_of(const DistributedResult& result) {
  const std::size_t mine = result.contacts.size();
  std::vector<std::size_t> counts(static_cast<std::size_t>(rank_count()));
  MPI_Allgather(&mine, sizeof(mine), MPI_BYTE, counts.data(), sizeof(mine), MPI_BYTE,
                MPI_COMM_WORLD);
  return counts;
}

TEST(ContactFiles, ContactsAreSortedOverTheRanks) {
  Random random(31);
  for (const int count : {0, 1, 2, 5, 100, 3000}) {
    for (const double share_of_first : {0.0, 0.9, 1.0}) {
      SCOPED_TRACE(std::to_string(count) + " contacts, " + std::to_string(share_of_first));
      ScatteredContacts scattered = scatter_contacts(count, share_of_first, random);
      scattered.mine.others_lower = 0.25;
      sort_over_ranks(MPI_COMM_WORLD, scattered.mine);
      EXPECT_EQ(scattered.mine.others_lower, 0.25);
      const std::vector<std::size_t> counts = counts_of(scattered.mine);
      std::size_t first = 0;
      for (std::size_t rank = 0; rank < counts.size(); ++rank) {
        EXPECT_LE(counts[rank], 2 * scattered.all.size() / counts.size() + 1);
        if (static_cast<int>(rank) == own_rank()) {
          ASSERT_LE(first + counts[rank], scattered.all.size());
          EXPECT_TRUE(std::equal(scattered.mine.contacts.begin(), scattered.mine.contacts.end(),
                                 scattered.all.begin() + static_cast<std::ptrdiff_t>(first),
                                 are_same));
        }
        first += counts[rank];
      }
      EXPECT_EQ(first, scattered.all.size());
    }
  }
}

std::string bytes_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_contacts(MPI_Comm ranks, const std::string& path, const DistributedResult& result,
                    const FiberNames& names = {}) {
  DistributedFileOptions options;
  options.run = "a test";
  DistributedContactWriter writer(ranks, path, options);
  writer.write(0, result, names);
  writer.finish();
}

TEST(ContactFiles, TheFileIsTheSameForAnyNumberOfRanks) {
  const SharedFolder folder;
  Random random(32);
  for (const int count : {0, 1, 3, 1000}) {
    SCOPED_TRACE(count);
    ScatteredContacts scattered = scatter_contacts(count, 0.0, random);
    sort_over_ranks(MPI_COMM_WORLD, scattered.mine);
    write_contacts(MPI_COMM_WORLD, folder / "ranks.h5", scattered.mine);
    if (own_rank() == 0) {
      DistributedResult all;
      all.contacts = scattered.all;
      write_contacts(MPI_COMM_SELF, folder / "one.h5", all);
      EXPECT_TRUE(bytes_in(folder / "ranks.h5") == bytes_in(folder / "one.h5"));
      EXPECT_GT(std::filesystem::file_size(folder / "one.h5"),
                169 * static_cast<std::uintmax_t>(count));
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }
}

TEST(ContactFiles, NamesOfFibresStandInTheFileOnce) {
  const SharedFolder folder;
  Random random(34);
  ScatteredContacts scattered = scatter_contacts(5, 0.0, random);
  sort_over_ranks(MPI_COMM_WORLD, scattered.mine);
  write_contacts(MPI_COMM_WORLD, folder / "named.h5", scattered.mine,
                 FiberNames({"rope", "a tube"}));
  write_contacts(MPI_COMM_WORLD, folder / "numbered.h5", scattered.mine);
  const std::string named = bytes_in(folder / "named.h5");
  const std::size_t place = named.find("rope\na tube\n");
  EXPECT_NE(place, std::string::npos);
  EXPECT_EQ(named.find("a tube", place + 11), std::string::npos);
  EXPECT_NE(named.find("fiber_names"), std::string::npos);
  EXPECT_EQ(bytes_in(folder / "numbered.h5").find("fiber_names"), std::string::npos);
}

TEST(ContactFiles, ARunGoesOnAfterTheLastWholeFrame) {
  const SharedFolder folder;
  Random random(33);
  DistributedFileOptions options;
  options.has_frames = true;
  options.run = "margin 1";
  std::vector<DistributedResult> frames;
  for (int i = 0; i < 4; ++i) {
    ScatteredContacts scattered = scatter_contacts(50 * i, 0.0, random);
    sort_over_ranks(MPI_COMM_WORLD, scattered.mine);
    frames.push_back(std::move(scattered.mine));
  }
  const auto write_from = [&](DistributedContactWriter& writer, std::size_t count) {
    for (std::size_t i = writer.done(); i < count; ++i) {
      writer.write(static_cast<std::int64_t>(10 + i), frames[i]);
    }
  };
  {
    DistributedContactWriter whole(MPI_COMM_WORLD, folder / "whole.h5", options);
    write_from(whole, 4);
    whole.finish();
  }
  {
    DistributedContactWriter interrupted(MPI_COMM_WORLD, folder / "again.h5", options);
    write_from(interrupted, 2);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "again.h5"));
  MPI_Barrier(MPI_COMM_WORLD);
  options.resume = true;
  options.run = "margin 2";
  EXPECT_THROW(DistributedContactWriter(MPI_COMM_WORLD, folder / "again.h5", options),
               std::invalid_argument);
  options.run = "margin 1";
  {
    DistributedContactWriter again(MPI_COMM_WORLD, folder / "again.h5", options);
    EXPECT_EQ(again.done(), 2u);
    EXPECT_THROW(again.write(11, frames[2]), std::invalid_argument);  // as the second frame
    write_from(again, 4);
    again.finish();
  }
  for (const std::string name : {"000000", "000001", "000002", "000003"}) {
    EXPECT_TRUE(bytes_in(folder / ("whole.frames/" + name + ".h5")) ==
                bytes_in(folder / ("again.frames/" + name + ".h5")));
  }
  MPI_Barrier(MPI_COMM_WORLD);
  // Without resume all is made anew.
  options.resume = false;
  DistributedContactWriter anew(MPI_COMM_WORLD, folder / "again.h5", options);
  EXPECT_EQ(anew.done(), 0u);
  EXPECT_FALSE(std::filesystem::exists(folder / "again.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "again.frames/000000.h5"));
}

}  // namespace
}  // namespace fiber::test
