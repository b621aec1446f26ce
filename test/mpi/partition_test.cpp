#include "src/mpi/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "test/mpi/scattered_fibers.hpp"

namespace fiber::test {
namespace {

TEST(Partition, DoesNotCutWhatIsFlatIntoSlices) {
  const Communicator ranks(MPI_COMM_WORLD);
  Random random(static_cast<std::uint64_t>(own_rank()) + 1);
  std::vector<PartitionObject> objects;
  for (int i = 0; i < 4000 / rank_count(); ++i) {
    objects.push_back(
        {{random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 0.01)}});
  }
  const std::vector<int> parts = partition(ranks, objects, 16);
  for (int part = 0; part < 16; ++part) {
    Eigen::Vector3d lower{1.0, 1.0, 1.0};
    Eigen::Vector3d upper{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (std::size_t axis = 0; axis < 3 && parts[i] == part; ++axis) {
        lower[axis] = std::min(lower[axis], objects[i].centre[axis]);
        upper[axis] = std::max(upper[axis], objects[i].centre[axis]);
      }
    }
    EXPECT_GT(ranks.max(upper[2]) - ranks.min(lower[2]), 0.009) << "part " << part;
  }
}

}  // namespace
}  // namespace fiber::test
