#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber {
namespace {

FiberFile parse(const std::string& text, double default_radius = 0.0) {
  std::istringstream stream(text);
  return read_csv(stream, "a.csv", default_radius);
}

std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

using Offsets = std::vector<std::uint32_t>;
using Radii = std::vector<double>;

TEST(ReadCsv, NumbersFibersInOrderOfAppearance) {
  const FiberFile file = parse(
      "fiber,x,y,z\n"
      "rope,0,0,0\nrope,1,-0.5,1e-3\nrope,+2,0,0\n"
      "7,5,5,5\n7,6,6,6\n",
      0.25);
  EXPECT_FALSE(file.has_frames);
  ASSERT_EQ(file.frames.size(), 1U);
  const FiberAssembly& fibers = file.frames[0].fibers;
  EXPECT_EQ(fibers.offsets(), (Offsets{0, 3, 5}));
  EXPECT_EQ(fibers.points()[1], Eigen::Vector3d(1.0, -0.5, 1e-3));
  EXPECT_EQ(fibers.points()[2], Eigen::Vector3d(2.0, 0.0, 0.0));
  EXPECT_EQ(fibers.radii(), Radii{0.25});
}

TEST(ReadCsv, RadiusColumnWinsOverTheDefault) {
  EXPECT_EQ(parse("fiber,x,y,z,radius\n0,0,0,0,0.5\n0,1,0,0,0.5\n", 0.25).frames[0].fibers.radii(),
            Radii{0.5});
  EXPECT_EQ(parse("fiber,x,y,z,radius\n0,0,0,0,0.5\n0,1,0,0,0.75\n").frames[0].fibers.radii(),
            (Radii{0.5, 0.75}));
}

TEST(ReadCsv, KeepsFramesInTheFilesOrder) {
  const FiberFile file = parse(
      "frame,fiber,x,y,z\n"
      "12,0,0,0,0\n12,0,1,0,0\n"
      "-3,0,0,1,0\n-3,0,1,1,0\n-3,1,0,2,0\n-3,1,1,2,0\n");
  EXPECT_TRUE(file.has_frames);
  ASSERT_EQ(file.frames.size(), 2U);
  EXPECT_EQ(file.frames[0].frame, 12);
  EXPECT_EQ(file.frames[0].fibers.fiber_count(), 1U);
  EXPECT_EQ(file.frames[1].frame, -3);
  EXPECT_EQ(file.frames[1].fibers.offsets(), (Offsets{0, 2, 4}));
}

TEST(ReadCsv, ToleratesWhatEditorsAndSpreadsheetsAdd) {
  const FiberFile file =
      parse("\xEF\xBB\xBF fiber , x,y ,z\r\n a , 0, 0 ,0\r\na,1,\t0,0\r\n\r\n  \n\n");
  EXPECT_EQ(file.frames[0].fibers.points()[1], Eigen::Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(parse("fiber,x,y,z\n0,0,0,0\n0,1,0,0").frames[0].fibers.point_count(), 2U)
      << "a last line without an end";
}

TEST(ReadCsv, AcceptsAFileOfNoFibers) {
  EXPECT_EQ(parse("fiber,x,y,z\n").frames.at(0).fibers.fiber_count(), 0U);
  EXPECT_TRUE(parse("frame,fiber,x,y,z\n").frames.empty());
}

TEST(ReadCsv, RefusesABadHeader) {
  const std::string rule =
      ", expected the columns x, y, z, if any frame, fiber, radius, closed, joint (or a name that "
      "ends as its format)";
  EXPECT_EQ(refusal(""), "a.csv: is empty" + rule);
  EXPECT_EQ(refusal("# only a comment\n"), "a.csv: is empty" + rule);
  EXPECT_EQ(refusal("\n0,0,0,0\n"), "a.csv:2: the header is '0,0,0,0'" + rule);
  EXPECT_EQ(refusal("frame\n"), "a.csv:1: the header is 'frame'" + rule);
  EXPECT_EQ(refusal(",fiber,x,y\n"), "a.csv:1: the header is ',fiber,x,y'" + rule)
      << "with all that stands in it";
  EXPECT_EQ(refusal("fiber,x;y,z\n"), "a.csv:1: the header is 'fiber,x;y,z'" + rule);
  EXPECT_EQ(refusal("fiber,x,y,z,X\n"), "a.csv:1: the header has the column x twice");
}

TEST(ReadCsv, RefusesBadValuesNamingLineAndReason) {
  const std::string head = "fiber,x,y,z,radius\n0,0,0,0,0\n";
  EXPECT_EQ(refusal(head + "0,abc,0,0,0\n"), "a.csv:3: x is 'abc', expected a number");
  EXPECT_EQ(refusal(head + "0,0,1.5m,0,0\n"), "a.csv:3: y is '1.5m', expected a number");
  EXPECT_EQ(refusal(head + "0,0,0,,0\n"), "a.csv:3: z is '', expected a number");
  EXPECT_EQ(refusal(head + "0,+-1,0,0,0\n"), "a.csv:3: x is '+-1', expected a number");
  EXPECT_EQ(refusal(head + "0,0,0,1e999,0\n"), "a.csv:3: z is '1e999', expected a number");
  EXPECT_EQ(refusal(head + "0,0,0,0\n"), "a.csv:3: has 4 values, expected 5 as in the header");
  EXPECT_EQ(refusal(head + "0,0,0,0,0,\n"), "a.csv:3: has 6 values, expected 5 as in the header");
  EXPECT_EQ(refusal(head + ",0,0,0,0\n0,1,0,0,0\n"), "a.csv:3: fiber is empty, expected a name");
  EXPECT_EQ(refusal(head + "0,0,0,0,0\n,0,0,0,0\n"), "a.csv:4: fiber is empty, expected a name");
  EXPECT_EQ(refusal(head + "0,0,0,0,0\n\"\",0,0,0,0\n"),
            "a.csv:4: fiber is empty, expected a name");
  EXPECT_EQ(refusal(head + "0,0,\"0,5\",0,0\n"),
            "a.csv:3: y is '0,5', expected a number with a decimal point");
  EXPECT_EQ(refusal("fiber;x;y;z\n0;0,5;0;0\n"),
            "a.csv:2: x is '0,5', expected a number with a decimal point");
  EXPECT_EQ(refusal(head + "\"0,0,0,0,0\n"), "a.csv:3: value 1 has no closing quote on its line");
  EXPECT_EQ(refusal(head + "0,\"0\"1,0,0,0\n"), "a.csv:3: value 2 goes on after its closing quote");
  EXPECT_EQ(refusal("x y z\n0 \"0\"1 0\n"), "a.csv:2: value 2 goes on after its closing quote");
  EXPECT_EQ(refusal(head + "0,0,0,nan,0\n"),
            "a.csv:3: z is 'nan', coordinates must be finite and at most 1e150 m in magnitude");
  EXPECT_EQ(refusal(head + "0,0,-inf,0,0\n"),
            "a.csv:3: y is '-inf', coordinates must be finite and at most 1e150 m in magnitude");
  EXPECT_EQ(refusal(head + "0,1e200,0,0,0\n"),
            "a.csv:3: x is '1e200', coordinates must be finite and at most 1e150 m in magnitude");
  EXPECT_EQ(refusal(head + "0,0,0,0,nan\n"),
            "a.csv:3: radius is 'nan', radii must be finite, at least 0 and at most 1e150 m");
  EXPECT_EQ(refusal(head + "0,0,0,0,inf\n"),
            "a.csv:3: radius is 'inf', radii must be finite, at least 0 and at most 1e150 m");
  EXPECT_EQ(refusal(head + "0,0,0,0,-0.001\n"),
            "a.csv:3: radius is '-0.001', radii must be finite, at least 0 and at most 1e150 m");
  EXPECT_EQ(refusal("frame,fiber,x,y,z\n1.5,0,0,0,0\n"),
            "a.csv:2: frame is '1.5', expected a whole number");
}

TEST(ReadCsv, RefusesAFiberOfOnePoint) {
  const std::string rule =
      "a fibre needs at least 2; skip_single_points, --skip-single-points, leaves such fibres out";
  EXPECT_EQ(refusal("fiber,x,y,z\na,0,0,0\nb,0,0,0\nb,1,0,0\n"),
            "a.csv:2: fibre 'a' has only this point, " + rule);
  EXPECT_EQ(refusal("frame,fiber,x,y,z\n0,a,0,0,0\n0,a,1,0,0\n1,a,0,0,0\n2,a,0,0,0\n2,a,1,0,0\n"),
            "a.csv:4: fibre 'a' has only this point, " + rule);
  EXPECT_EQ(refusal("fiber,x,y,z\na,0,0,0\n"), "a.csv:2: fibre 'a' has only this point, " + rule);
}

TEST(ReadCsv, ReadsLinesAndValuesUpToTheirLongest) {
  constexpr std::size_t longest_line = 65'536;
  constexpr std::size_t longest_value = 4'096;
  const std::string head = "fiber,x,y,z\n0,0,0,0\n";
  const auto padded = [](std::size_t size) {
    const std::string row = "0,1,0,0";
    return row + std::string(size - row.size(), ' ');
  };
  const std::string too_long =
      "a.csv:3: is longer than 65536 bytes and begins with '" + padded(40) + "'";
  for (const char* end : {"\n", ""}) {
    EXPECT_EQ(refusal(head + padded(longest_line) + end), "accepted");
    EXPECT_EQ(refusal(head + padded(longest_line + 1) + end), too_long);
  }
  EXPECT_EQ(refusal(head + padded(longest_line) + "\n" + padded(longest_line) + "\n0,x,0,0\n"),
            "a.csv:5: x is 'x', expected a number");

  const auto with_value = [&head](std::size_t size) {
    return head + "0,1," + std::string(size - 1, '0') + "1,0\n";
  };
  EXPECT_EQ(parse(with_value(longest_value)).frames.at(0).fibers.points().at(1),
            Eigen::Vector3d(1.0, 1.0, 0.0));
  const std::string reason = refusal(with_value(longest_value + 1));
  EXPECT_EQ(reason.substr(0, reason.find(": '")),
            "a.csv:3: value 3 has 4097 bytes, at most 4096 are allowed");
}

TEST(ReadCsv, RefusesABadDefaultRadius) {
  EXPECT_THROW(parse("fiber,x,y,z\n", -1.0), std::invalid_argument);
  EXPECT_THROW(parse("fiber,x,y,z\n", std::numeric_limits<double>::quiet_NaN()),
               std::invalid_argument);
}

TEST(ReadCsv, NamesAFileThatCannotBeRead) {
  try {
    read_csv("/no/such/place/a.csv");
    FAIL() << "accepted";
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "/no/such/place/a.csv: cannot be opened: No such file or directory");
  }
  try {
    read_csv("/");
    FAIL() << "accepted";
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "/: cannot be read: Is a directory");
  }
}

FiberAssembly awkward_numbers(Radii radii) {
  return {{{0.1, 1.0 / 3.0, -0.0},
           {5e-324, 1.7976931348623157e-308, 1e149},
           {std::nextafter(1.0, 2.0), 123456789.123456789, -1e-17},
           {0.0, 1e22, 9007199254740993.0}},
          {0, 2, 4},
          std::move(radii)};
}

std::string content(const std::string& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(WriteCsv, ReadsBackAsTheSameNumbers) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("a.csv");
  const std::vector<Radii> all_radii{{0.1}, {1e-9, 0.7}, {0.0, 0.1, 0.2, 1.0 / 3.0}};
  for (const Radii& radii : all_radii) {
    const FiberAssembly fibers = awkward_numbers(radii);
    write_csv(path, {true, {{4, fibers}, {2, fibers}}});
    const FiberFile file = read_csv(path);
    ASSERT_TRUE(file.has_frames);
    ASSERT_EQ(file.frames.size(), 2U);
    EXPECT_EQ(file.frames[1].frame, 2);
    for (const FiberFrame& frame : file.frames) {
      EXPECT_EQ(frame.fibers.points(), fibers.points());
      EXPECT_EQ(frame.fibers.offsets(), fibers.offsets());
      for (const std::uint32_t point : {0U, 2U}) {
        EXPECT_EQ(frame.fibers.segment_radius(point), fibers.segment_radius(point));
      }
    }
  }
}

TEST(WriteCsv, WritesShortestDecimals) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("a.csv");
  write_csv(path, {false, {{0, FiberAssembly({{0.1, 0, -2.5}, {1e-7, 3, 1e30}}, {0, 2}, {0.2})}}});
  EXPECT_EQ(content(path), "fiber,x,y,z,radius\n0,0.1,0,-2.5,0.2\n0,1e-07,3,1e+30,0.2\n");
}

TEST(WriteCsv, RefusesWhatAFileCannotHold) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("a.csv");
  const FiberAssembly fibers = awkward_numbers({0.0});
  EXPECT_THROW(write_csv(path, {false, {{0, fibers}, {1, fibers}}}), std::invalid_argument);
  EXPECT_THROW(write_csv(path, {true, {{0, FiberAssembly()}}}), std::invalid_argument);
  EXPECT_THROW(write_csv(path, {true, {{0, fibers}, {0, fibers}}}), std::invalid_argument);
}

TEST(WriteCsv, NamesAFileThatCannotBeWritten) {
  const FiberFile file{false, {{0, awkward_numbers({0.0})}}};
  EXPECT_THROW(write_csv("/no/such/place/a.csv", file), FileError);
  EXPECT_THROW(write_csv("/dev/full", file), FileError);
}

}  // namespace
}  // namespace fiber
