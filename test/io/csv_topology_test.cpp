// Closed and joined fibres in CSV files.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/one_frame.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber {
namespace {

FiberFile read_topology(const std::string& text) {
  std::istringstream stream(text);
  return read_csv(stream, "net.csv", 0.25);
}

std::string error_in_topology(const std::string& text) {
  try {
    read_topology(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

/// A ring and a branch that begins at its second point.
const std::string net =
    "fiber,x,y,z,closed,joint\n"
    "ring,0,0,0,1,\nring,1,0,0,1,7\nring,0,1,0,1,-1\n"
    "branch,1,0,0,0,7\nbranch,2,0,0,0,\n";

TEST(CsvTopology, IsReadAndWritten) {
  const FiberFile file = read_topology(net);
  EXPECT_TRUE(file.notes.empty());
  const FiberAssembly& fibers = file.frames.at(0).fibers;
  EXPECT_TRUE(fibers.is_closed(0));
  EXPECT_FALSE(fibers.is_closed(1));
  EXPECT_EQ(fibers.given_offsets(), (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_EQ(fibers.topology().joints, (std::vector<std::int32_t>{-1, 7, -1, 7, -1}));
  EXPECT_EQ(fibers.segment_count(), 4U);
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("net.csv");
  write_csv(path, file);
  const FiberFile again = read_csv(path);
  ASSERT_EQ(again.frames.size(), 1U);
  EXPECT_TRUE(again.frames[0].fibers.has_topology_of(fibers));
  EXPECT_EQ(again.frames[0].fibers.points(), fibers.points());
  EXPECT_EQ(again.frames[0].names, file.frames[0].names);
}

TEST(CsvTopology, RowsOfAFibreNeedNotStandTogether) {
  const FiberFile file = read_topology(
      "fiber,x,y,z,closed,joint\nring,0,0,0,1,\nbranch,1,0,0,0,7\nring,1,0,0,1,7\nbranch,2,0,0,0,\n"
      "ring,0,1,0,1,-1\n");
  const FiberFile sorted = read_topology(net);
  EXPECT_TRUE(file.frames.at(0).fibers.has_topology_of(sorted.frames.at(0).fibers));
  EXPECT_EQ(file.frames[0].fibers.points(), sorted.frames[0].fibers.points());
}

TEST(CsvTopology, WhatIsWrongIsNamed) {
  const std::string header = "fiber,x,y,z,closed,joint\n";
  EXPECT_EQ(error_in_topology(header + "a,0,0,0,yes,\na,1,0,0,1,\n"),
            "net.csv:2: closed is 'yes', expected 0 or 1");
  EXPECT_EQ(error_in_topology(header + "a,0,0,0,0,1.5\na,1,0,0,0,\n"),
            "net.csv:2: joint is '1.5', expected a whole number below 2147483648, or nothing");
  EXPECT_EQ(error_in_topology(header + "a,0,0,0,1,\na,1,0,0,1,\na,0,1,0,0,\n"),
            "net.csv: fibre 'a' is closed in some of its rows and open in others, closed must be "
            "the same in all");
  EXPECT_EQ(error_in_topology(header + "a,0,0,0,1,\na,1,0,0,1,\n"),
            "net.csv: frame 0: fibre 0: is closed and has 2 points, a closed fibre needs at least "
            "3");
  const std::string apart = error_in_topology(
      "fiber,x,y,z,radius,joint\na,0,0,0,0.1,4\na,1,0,0,0.1,\nb,0,2,0,0.1,4\nb,0,3,0,0.1,\n");
  EXPECT_EQ(apart.rfind("net.csv: frame 0: joint 4: fibre 0, point 0 and fibre 1, point 0 are 2 m "
                        "apart; points that are joined must lie within 0.1 m",
                        0),
            0U)
      << apart;
}

TEST(CsvTopology, AJointOfOnePointIsNoted) {
  const FiberFile file =
      read_topology("frame,fiber,x,y,z,joint\n5,a,0,0,0,3\n5,a,1,0,0,\n6,a,0,0,0,\n6,a,1,0,0,\n");
  ASSERT_EQ(file.notes.size(), 1U);
  EXPECT_EQ(file.notes[0], "frame 5: joint 3 is the number of one point alone: it joins nothing");
}

TEST(CsvTopology, AFileThatBegunWithoutColumnsForItRefusesIt) {
  const test::TemporaryDirectory directory;
  CsvWriter writer(directory.path("late.csv"), true);
  FiberFrame frame;
  frame.fibers = FiberAssembly({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 3}, {0.1});
  writer.write(frame);
  frame.frame = 1;
  frame.fibers = FiberAssembly({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 3}, {0.1}, {{1}, {}, {}});
  EXPECT_THROW(writer.write(frame), std::invalid_argument);
}

TEST(FormatsOfOneFrame, TellThatTheyLoseWhatIsClosedOrJoined) {
  FiberFrame frame;
  frame.fibers = FiberAssembly({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 3}, {0.1});
  EXPECT_TRUE(losses(FileFormat::HAIR, frame).empty());
  frame.fibers = FiberAssembly({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 3}, {0.1}, {{1}, {}, {}});
  EXPECT_EQ(losses(FileFormat::HAIR, frame).size(), 1U);
}

}  // namespace
}  // namespace fiber
