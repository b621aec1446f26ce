// Closed and joined fibres in files.
#include <gtest/gtest.h>

#include <sstream>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/support/error_of.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Numbers = std::vector<std::int32_t>;

FiberFile read_joints(const std::string& text) {
  std::istringstream stream(text);
  return read_csv(stream, "joints.csv", 0.1);
}

std::string error_in_joints(const std::string& text) {
  try {
    read_joints(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

const char* const ring_and_tail =
    "fiber,x,y,z,radius,closed,joint\n"
    "ring,0,0,0,0.1,1,\n"
    "ring,1,0,0,0.1,1,-3\n"
    "ring,1,1,0,0.2,1,4\n"
    "tail,1,1,0,0.1,0,4\n"
    "tail,2,2,0,0.1,0,\n";

TEST(CsvJoints, AreRead) {
  const FiberFile file = read_joints(ring_and_tail);
  const FiberAssembly& fibers = file.frames.at(0).fibers;
  EXPECT_TRUE(fibers.is_closed(0));
  EXPECT_FALSE(fibers.is_closed(1));
  EXPECT_EQ(fibers.segment_count(), 4U);
  EXPECT_EQ(fibers.topology().joints, (Numbers{-1, -1, 4, 4, -1}));
  EXPECT_EQ(fibers.given_offsets(), (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_TRUE(file.notes.empty());
  const FiberFile numbers =
      read_joints("x,y,z,closed,joint\n0,0,0,1.0,3.0e+00\n1,0,0,1,-1\n1,1,0,1,\n");
  EXPECT_TRUE(numbers.frames.at(0).fibers.is_closed(0));
  EXPECT_EQ(read_joints("fiber,x,y,z,closed\na,0,0,0,0\na,1,0,0,0\n").frames[0].fibers.graph(),
            nullptr);
}

TEST(CsvJoints, RowsOfAFiberMayStandAnywhere) {
  const FiberFile file = read_joints(
      "fiber,x,y,z,closed,joint\na,0,0,0,1,\nb,1,1,0,0,9\na,1,0,0,1,\nb,2,2,0,0,\na,1,1,0,1,9\n");
  EXPECT_EQ(file.frames.at(0).fibers.topology().joints, (Numbers{-1, -1, 9, 9, -1}));
  EXPECT_TRUE(file.frames.at(0).fibers.is_closed(0));
}

TEST(CsvJoints, AJointOfOnePointIsTold) {
  const std::string lonely = "fiber,x,y,z,joint\na,0,0,0,5\na,1,0,0,6\nb,0,0,1,\nb,1,0,1,\n";
  EXPECT_EQ(read_joints(lonely).notes,
            std::vector<std::string>{"joint 5 is of one point only, and so are 1 more: what is "
                                     "joined has the same number"});
  EXPECT_EQ(read_joints("frame,x,y,z,joint\n7,0,0,0,5\n7,1,0,0,\n").notes.at(1),
            "joint 5 is of one point only in frame 7: what is joined has the same number");
}

TEST(CsvJoints, ErrorsNameTheirPlace) {
  const auto closed = [](const std::string& value) {
    return error_in_joints("x,y,z,closed\n0,0,0," + value + "\n");
  };
  for (const char* const value : {"2", "yes", "", "-1", "nan"}) {
    EXPECT_EQ(closed(value),
              "joints.csv:2: closed is '" + std::string(value) + "', expected 0 or 1");
  }
  EXPECT_EQ(error_in_joints("x,y,z,joint\n0,0,0,a\n"),
            "joints.csv:2: joint is 'a', expected a whole number");
  EXPECT_EQ(error_in_joints("x,y,z,joint\n0,0,0,2147483648\n"),
            "joints.csv:2: joint is '2147483648', it must be at most 2147483647");
  EXPECT_EQ(error_in_joints("fiber,x,y,z,closed\na,0,0,0,1\na,1,0,0,0\na,1,1,0,1\n"),
            "joints.csv: fibre 'a' is closed in some of its rows and not in others");
  EXPECT_EQ(error_in_joints("fiber,x,y,z,closed\na,0,0,0,1\na,1,0,0,1\n"),
            "joints.csv: frame 0: fibre 0: is closed and has 2 points, a closed fibre needs at "
            "least 3");
  EXPECT_EQ(error_in_joints("frame,fiber,x,y,z,joint\n3,a,0,0,0,1\n3,a,1,0,0,\n3,b,2,0,0,1\n"
                            "3,b,3,0,0,\n"),
            "joints.csv: frame 3: joint 1: fibre 0, point 0 and fibre 1, point 0 are 2 m apart; "
            "points that are joined must lie within 0.1 m, the largest radius that meets there or "
            "1e-6 of the largest coordinate");
}

TEST(CsvJoints, AreWrittenAndReadBack) {
  const TemporaryDirectory folder;
  const std::string path = folder.path("ring.csv");
  const FiberFile file = read_joints(ring_and_tail);
  write_csv(path, file);
  const FiberFile back = read_csv(path);
  const FiberAssembly& fibers = back.frames.at(0).fibers;
  EXPECT_TRUE(fibers.has_topology_of(file.frames[0].fibers));
  EXPECT_EQ(fibers.given_points(), file.frames[0].fibers.given_points());
  EXPECT_EQ(fibers.given_radii(), file.frames[0].fibers.given_radii());
  const FiberAssembly plain({{0, 0, 0}, {1, 0, 0}}, {0, 2}, {0.1});
  CsvWriter frames(folder.path("frames.csv"), true);
  frames.write({0, plain});
  EXPECT_EQ(error_of([&] {
              frames.write({1, fibers});
            }),
            "frame 1 has fibres that are closed or joined, the first frame has none: the file has "
            "no columns for them");
  EXPECT_EQ(error_of([&] { write_hair(folder.path("ring.hair"), file); }),
            "a .hair file cannot hold this: fibres that are closed or joined; .csv holds them");
}

}  // namespace
}  // namespace fiber::test
