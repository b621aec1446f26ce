// .swc files: trees whose branches are joints.
#include "src/io/fiber_formats.hpp"
#include "test/io/format.hpp"

namespace fiber::test {
namespace {

std::string swc_refusal(const std::string& text, const ReadOptions& options = {}) {
  return refusal(read_swc, text, options);
}

const std::string swc_tree =
    "# a tree\n"
    " 1 2 0 0 0 3 -1\n"
    "2 3 1000000 0 0 2 1  # goes on\n"
    "\n"
    "3 3 2000000 0 0 1 2\n"
    "4 3 2000000 1000000 0 1 3\r\n"
    "5 3 2000000 2000000 0 0.5 4\n"
    "6 3 2000000 -1000000 0 1 3\n";

TEST(ReadSwc, SectionsAreFibresAndBranchesJoints) {
  const FiberFile file = read_text(read_swc, swc_tree);
  EXPECT_TRUE(file.notes.empty());
  FiberTopology topology;
  topology.joints = {-1, -1, 0, 0, -1, -1, 0, -1};
  expect_same_fibers(
      file.frames.at(0).fibers,
      {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {2, 0, 0}, {2, -1, 0}},
       {0, 3, 6, 8},
       {3e-6, 2e-6, 1e-6, 1e-6, 1e-6, 0.5e-6, 1e-6, 1e-6},
       topology});
}

TEST(ReadSwc, ParentsMayComeLaterAndRootsMayBranch) {
  // A root of three branches, whose points come before it, and a chain of its own.
  const FiberFile file = read_text(read_swc,
                                   "11 3 1 0 0 1 10\n12 3 0 1 0 1 10\n13 3 0 0 1 1 10\n"
                                   "10 0 0 0 0 1 -1\n20 7 5 5 5 1 -1\n21 7 6 6 6 1 20\n");
  const FiberAssembly& fibers = file.frames.at(0).fibers;
  EXPECT_EQ(fibers.offsets(), (std::vector<std::uint32_t>{0, 2, 4, 6, 8}));
  EXPECT_EQ(fibers.topology().joints, (std::vector<std::int32_t>{0, -1, 0, -1, 0, -1, -1, -1}));
  EXPECT_EQ(fibers.points()[2], Eigen::Vector3d(0, 0, 0));
}

TEST(ReadSwc, TheSomaIsLeftOutAndTold) {
  const FiberFile file =
      read_text(read_swc,
                "1 1 0 0 0 9 -1\n2 1 0 9 0 9 1\n3 1 0 -9 0 9 1\n4 3 10 0 0 1 1\n5 3 20 0 0 1 4\n"
                "6 2 -10 0 0 1 1\n7 2 -20 0 0 1 6\n");
  EXPECT_EQ(file.frames.at(0).fibers.offsets(), (std::vector<std::uint32_t>{0, 2, 4}));
  EXPECT_TRUE(file.frames.at(0).fibers.topology().joints.empty());
  EXPECT_EQ(file.notes,
            std::vector<std::string>{"3 points of the soma are not read: neurites begin at their "
                                     "first own point"});
}

/// Every segment of a random tree is a segment of a fibre once, with its radii, and every fibre
/// ends where another begins or the tree does.
TEST(ReadSwc, RandomTreesKeepTheirSegments) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int trial = 0; trial < 100; ++trial) {
    const int count = random.integer(2, 60);
    std::vector<int> parents{-1};
    std::vector<int> children(static_cast<std::size_t>(count), 0);
    std::string text = "0 2 0 0 0 1 -1\n";
    for (int node = 1; node < count; ++node) {
      parents.push_back(random.integer(std::max(0, node - 4), node - 1));
      ++children[static_cast<std::size_t>(parents.back())];
      text += std::to_string(node) + " 2 " + std::to_string(node) + "000000 0 0 1 " +
              std::to_string(parents.back()) + "\n";
    }
    const FiberAssembly fibers = read_text(read_swc, text).frames.at(0).fibers;
    ASSERT_EQ(fibers.segment_count(), static_cast<std::size_t>(count) - 1);
    std::vector<int> seen(static_cast<std::size_t>(count), 0);
    const std::vector<std::int32_t> joints = fibers.topology().joints;
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      for (std::uint32_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
        const int node = static_cast<int>(fibers.points()[i].x());
        EXPECT_EQ(!joints.empty() && joints[i] >= 0, children[static_cast<std::size_t>(node)] > 1);
        if (i > fibers.offsets()[fiber]) {
          EXPECT_EQ(parents[static_cast<std::size_t>(node)],
                    static_cast<int>(fibers.points()[i - 1].x()));
          ++seen[static_cast<std::size_t>(node)];
        }
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), count - 1);
  }
}

TEST(ReadSwc, RefusesWhatIsNoTree) {
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1 -1\n2 2 1 0 0 1 7\n"),
            ":2: parent is 7, there is no such point");
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1 -1\n2 2 1 0 0 1 4\n3 2 2 0 0 1 2\n4 2 3 0 0 1 3\n"),
            ":2: point 2 is among its own ancestors");
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1 1\n"), ":1: point 1 is among its own ancestors");
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1 -1\n\n1 2 1 0 0 1 1\n"), ":3: id is 1, which line 1 has, too");
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1 -1\n"),
            ": fibre 0 has 1 point, a fibre needs at least 2; skip_single_points, "
            "--skip-single-points, leaves such fibres out");
  EXPECT_EQ(swc_refusal(""), "accepted");
}

TEST(ReadSwc, RefusesBadLines) {
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1\n"),
            ":1: is '1 2 0 0 0 1', expected id type x y z radius parent");
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1 -1 8\n"),
            ":1: is '1 2 0 0 0 1 -1 8', expected id type x y z radius parent");
  EXPECT_EQ(swc_refusal("-1 2 0 0 0 1 -1\n"), ":1: id is '-1', expected a whole number from 0");
  EXPECT_EQ(swc_refusal("1 a 0 0 0 1 -1\n"), ":1: type is 'a', expected a whole number");
  EXPECT_EQ(swc_refusal("1 2 0 0 0 1 -2\n"), ":1: parent is '-2', expected a whole number from -1");
  EXPECT_EQ(swc_refusal("1 2 0 zero 0 1 -1\n"), ":1: y is 'zero', expected a number");
  EXPECT_EQ(swc_refusal("1 2 0 nan 0 1 -1\n"),
            ":1: y is 'nan', " + std::string(FiberAssembly::coordinate_rule));
  EXPECT_EQ(swc_refusal("1 2 0 0 0 -1 -1\n"),
            ":1: radius is '-1', " + std::string(FiberAssembly::radius_rule));
  expect_wrong_bits_read_or_refused(read_swc, swc_tree);
}

}  // namespace
}  // namespace fiber::test
