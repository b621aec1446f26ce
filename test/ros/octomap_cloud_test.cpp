#include <gtest/gtest.h>
#include <octomap_msgs/conversions.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "src/ros/bridges/octomap_bridge.hpp"
#include "test/support/error_of.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::test::error_of;
using fiber::test::Random;
using octomap_msgs::Octomap;
using Cells = std::vector<std::array<float, 3>>;  // centres, sorted

Cells cells_of(const Octomap& map) {
  const sensor_msgs::PointCloud2 cloud = to_cloud(map);
  EXPECT_EQ(cloud.header, map.header);
  EXPECT_EQ(cloud.data.size(), std::size_t{12} * cloud.width);
  Cells cells;
  if (cloud.width > 0) {
    for (sensor_msgs::PointCloud2ConstIterator<float> xyz(cloud, "x"); xyz != xyz.end(); ++xyz) {
      cells.push_back({xyz[0], xyz[1], xyz[2]});
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// What octomap itself says, of a tree without leaves larger than a cell.
template <class Tree>
Cells cells_of(Tree tree) {
  tree.expand();
  Cells cells;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (tree.isNodeOccupied(*leaf)) {
      const octomap::point3d centre = leaf.getCoordinate();
      cells.push_back({centre.x(), centre.y(), centre.z()});
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

template <class Tree>
std::size_t count_occupied_leaves(const Tree& tree) {
  return static_cast<std::size_t>(
      std::count_if(tree.begin_leafs(), tree.end_leafs(),
                    [&](const auto& leaf) { return tree.isNodeOccupied(leaf); }));
}

/// A cube of 2^level cells along an edge, at a multiple of that.
template <class Tree>
void set_cube(Tree& tree, const octomap::OcTreeKey& where, int level, float log_odds) {
  const auto edge = static_cast<octomap::key_type>(1 << level);
  octomap::OcTreeKey key;
  for (int i = 0; i < edge * edge * edge; ++i) {
    int rest = i;
    for (unsigned axis = 0; axis < 3; ++axis, rest /= edge) {
      key[axis] = static_cast<octomap::key_type>(where[axis] / edge * edge + rest % edge);
    }
    tree.setNodeValue(key, log_odds, true);
  }
}

/// Cubes here and there, at the ends of the octree too, free ones inside of occupied ones; some
/// as likely free as not, which octomap takes for occupied.
template <class Tree>
Tree random_tree(Random& random) {
  constexpr std::array<float, 4> log_odds{2.0F, 2.0F, 0.0F, -1e-3F};
  Tree tree(random.uniform(0.01, 2.0));
  const int base = random.integer(0, 2) * 32760;  // least keys, the middle, nearly the greatest
  for (int i = 0; i < 40; ++i) {
    octomap::OcTreeKey where;
    for (unsigned axis = 0; axis < 3; ++axis) {
      where[axis] = static_cast<octomap::key_type>(random.chance(0.9) ? base + random.integer(0, 15)
                                                                      : random.integer(0, 65535));
    }
    const auto state = static_cast<std::size_t>(random.integer(0, 3));
    set_cube(tree, where, random.integer(0, 3), log_odds[state]);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

template <class Tree>
Octomap full(const Tree& tree) {
  Octomap map;
  EXPECT_TRUE(octomap_msgs::fullMapToMsg(tree, map));
  map.header.frame_id = "map";
  map.header.stamp = ros::Time(7, 8);
  return map;
}

template <class Tree>
Octomap binary(const Tree& tree) {
  Octomap map;
  EXPECT_TRUE(octomap_msgs::binaryMapToMsg(tree, map));
  map.header.frame_id = "map";
  return map;
}

template <class Tree>
class OctomapCloud : public ::testing::Test {};
using Trees = ::testing::Types<octomap::OcTree, octomap::ColorOcTree>;
TYPED_TEST_SUITE(OctomapCloud, Trees);

TYPED_TEST(OctomapCloud, HoldsTheCellsThatOctomapTakesForOccupied) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  std::size_t pruned = 0;
  for (int i = 0; i < 20; ++i) {
    auto tree = random_tree<TypeParam>(random);
    pruned += cells_of(tree).size() - count_occupied_leaves(tree);
    EXPECT_EQ(cells_of(full(tree)), cells_of(tree));
    tree.toMaxLikelihood();
    tree.prune();
    EXPECT_EQ(cells_of(binary(tree)), cells_of(tree));
  }
  fiber::test::expect_enough(pruned, std::size_t{1001});
}

TYPED_TEST(OctomapCloud, OfAnEmptyTreeIsEmpty) {
  EXPECT_EQ(to_cloud(full(TypeParam(0.1))).width, 0U);
  EXPECT_EQ(to_cloud(binary(TypeParam(0.1))).width, 0U);
}

TYPED_TEST(OctomapCloud, RefusesDataThatEndTooEarlyOrTooLate) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  const auto tree = random_tree<TypeParam>(random);
  for (const Octomap& whole : {full(tree), binary(tree)}) {
    Octomap map = whole;
    map.data.push_back(0);
    EXPECT_EQ(error_of([&] { to_cloud(map); }),
              "the octree ends after " + std::to_string(whole.data.size()) + " of " +
                  std::to_string(map.data.size()) + " bytes of data");
    while (map.data.size() > 1) {
      map.data.resize(std::min(map.data.size() - 1, whole.data.size() - 1));
      const std::string size = std::to_string(map.data.size());
      ASSERT_EQ(error_of([&] { to_cloud(map); }),
                "data end after " + size + " bytes, in the middle of the octree");
      map.data.resize(map.data.size() - map.data.size() / 100);
    }
  }
}

Octomap map_of(const std::vector<std::int8_t>& data, bool is_binary = true,
               const std::string& id = "OcTree") {
  Octomap map;
  map.id = id;
  map.binary = is_binary ? 1 : 0;
  map.resolution = 1.0;
  map.data = data;
  return map;
}

TEST(OctomapCloudOfBadInput, HasAnEndForAnyBytes) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  int refused = 0;
  constexpr int count = 2000;
  for (int i = 0; i < count; ++i) {
    Octomap map = map_of({}, random.chance(0.5), random.chance(0.5) ? "OcTree" : "ColorOcTree");
    map.data.resize(static_cast<std::size_t>(random.integer(1, 1000)));
    for (std::int8_t& byte : map.data) {
      byte = static_cast<std::int8_t>(random.integer(-128, 127));
    }
    refused += error_of([&] { to_cloud(map); }) != "no error" ? 1 : 0;
  }
  fiber::test::expect_enough(refused, count * 9 / 10 + 1);
}

TEST(OctomapCloudOfBadInput, IsAnErrorForNodesThatCannotBe) {
  std::vector<std::int8_t> deep;
  for (int i = 0; i < 1'000'000; ++i) {
    deep.insert(deep.end(), {3, 0});
  }
  EXPECT_EQ(error_of([&] { to_cloud(map_of(deep)); }),
            "the octree is deeper than 16 levels at byte 32 of data");
  EXPECT_EQ(error_of([&] {
              to_cloud(map_of({3, 0, 0, 0}));
            }),
            "the inner node at byte 2 of data has no children");
  deep.clear();
  for (int i = 0; i < 1'000'000; ++i) {
    deep.insert(deep.end(), {0, 0, 0, 0, 1});
  }
  EXPECT_EQ(error_of([&] { to_cloud(map_of(deep, false)); }),
            "the octree is deeper than 16 levels at byte 85 of data");
  EXPECT_EQ(error_of([&] {
              to_cloud(map_of({0, 0, -64, 127, 0}, false));
            }),
            "the node that ends at byte 5 of data has log-odds of nan");
}

TEST(OctomapCloudOfBadInput, IsAnErrorForAnotherTypeOrResolution) {
  EXPECT_EQ(error_of([&] { to_cloud(map_of({}, true, "CountingOcTree")); }),
            "id is 'CountingOcTree', it must be OcTree, ColorOcTree or OcTreeStamped");
  Octomap map = map_of({});
  for (const double bad : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), 1e31}) {
    map.resolution = bad;
    const std::string error = error_of([&] { to_cloud(map); });
    EXPECT_EQ(error.rfind("resolution is ", 0), 0U) << error;
    EXPECT_NE(error.find("it must be the edge of a cell in metres, 1e-30 to 1e+30"),
              std::string::npos)
        << error;
  }
}

TEST(OctomapCloudOfBadInput, IsAnErrorForMoreCellsThanTheLimit) {
  // Along first children down to cubes of 256 cells, of whose octants of 128³ one or two are
  // occupied.
  std::vector<std::int8_t> data;
  for (int level = 0; level < 8; ++level) {
    data.insert(data.end(), {3, 0});
  }
  data.insert(data.end(), {2, 0});
  EXPECT_EQ(to_cloud(map_of(data)).width, 128U * 128 * 128);
  data[data.size() - 2] = 2 | 2 << 2;
  EXPECT_EQ(error_of([&] { to_cloud(map_of(data)); }),
            "more than 4000000 cells of the finest resolution are occupied, that many may be");
}

}  // namespace
}  // namespace fiber_proximity_ros
