#include "src/paper/hierarchy/binary_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace fiber {
namespace {

std::vector<std::uint32_t> counted(std::uint32_t n) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 7U);
  return order;
}

/// Segments below a node, from left to right.
void collect(const BinaryTree& tree, std::uint32_t node, std::vector<std::uint32_t>& segments) {
  if (tree.is_leaf(node)) {
    segments.push_back(tree.leaf_point(node));
    return;
  }
  collect(tree, tree.first_child(node), segments);
  collect(tree, tree.first_child(node) + 1, segments);
}

BinaryTree balanced(const std::vector<std::uint32_t>& order) {
  BinaryTree tree;
  tree.build(order, SplitInMiddle());
  return tree;
}

TEST(BinaryTree, OfNothingIsEmpty) {
  EXPECT_TRUE(balanced({}).empty());
  EXPECT_EQ(balanced({}).level_count(), 0U);
}

class BalancedTree : public testing::TestWithParam<std::uint32_t> {};

TEST_P(BalancedTree, HoldsEverySegmentOnceInOrder) {
  const BinaryTree tree = balanced(counted(GetParam()));
  std::vector<std::uint32_t> segments;
  collect(tree, 0, segments);
  EXPECT_EQ(segments, counted(GetParam()));
  EXPECT_EQ(tree.node_count(), 2 * GetParam() - 1);
}

TEST_P(BalancedTree, IsOneBalancedAndInLevelOrder) {
  const BinaryTree tree = balanced(counted(GetParam()));
  std::uint32_t nodes = 0;
  for (std::uint32_t level = 0; level < tree.level_count(); ++level) {
    for (std::uint32_t node = tree.level_begin(level); node < tree.level_end(level); ++node) {
      ++nodes;
      if (tree.is_leaf(node)) {
        EXPECT_GE(level + 2, tree.level_count());  // leaves on the last two levels only
      } else {
        EXPECT_GE(tree.first_child(node), tree.level_begin(level + 1));
        EXPECT_LT(tree.first_child(node) + 1, tree.level_end(level + 1));
      }
    }
  }
  EXPECT_EQ(nodes, tree.node_count());
}

TEST_P(BalancedTree, IsPerfectForPowersOfTwo) {
  const std::uint32_t n = GetParam();
  if ((n & (n - 1)) != 0) {
    return;
  }
  const BinaryTree tree = balanced(counted(n));
  const std::uint32_t last = tree.level_count() - 1;
  EXPECT_EQ(tree.level_end(last) - tree.level_begin(last), n);
}

TEST_P(BalancedTree, TellsTheLeavesBelowEachNode) {
  BinaryTree tree;
  std::vector<LeafRun> runs;
  tree.build(counted(GetParam()), SplitInMiddle(), &runs);
  ASSERT_EQ(runs.size(), tree.node_count());
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    std::vector<std::uint32_t> segments;
    collect(tree, node, segments);
    ASSERT_EQ(segments.size(), runs[node].size());
    ASSERT_EQ(segments.front(), runs[node].begin + 7);
  }
}

TEST(BinaryTree, TakesAnySplit) {
  BinaryTree list;
  list.build(counted(1000), [](std::uint32_t, const LeafRun& run) { return run.begin + 1; });
  EXPECT_EQ(list.level_count(), 1000U);
  std::vector<std::uint32_t> segments;
  collect(list, 0, segments);
  EXPECT_EQ(segments, counted(1000));
}

INSTANTIATE_TEST_SUITE_P(Sizes, BalancedTree,
                         testing::Values(1, 2, 3, 4, 5, 7, 8, 9, 31, 64, 100, 1023, 1024, 1025));

}  // namespace
}  // namespace fiber
