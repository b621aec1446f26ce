// Fibres of one point are refused, or left out and counted, in every format that can hold them.
#include <sstream>

#include "test/io/format.hpp"

namespace fiber::test {
namespace {

ReadOptions skipping() {
  ReadOptions options;
  options.skip_single_points = true;
  return options;
}

FiberFile read_rows(std::istream& stream, const std::string& name, const ReadOptions& options) {
  return read_csv(stream, name, options);
}

FiberFile read_strands(std::istream& stream, const std::string& name, const ReadOptions& options) {
  return read_hair(stream, name, options);
}

TEST(SinglePoints, RowsOfCsvKeepTheirNamesAndRadii) {
  const std::string text =
      "frame,fiber,x,y,z,radius\n0,a,9,9,9,0.5\n0,b,0,0,0,1\n0,b,1,0,0,2\n0,c,9,9,9,0.5\n"
      "0,d,3,0,0,3\n0,d,4,0,0,4\n1,a,5,0,0,1\n1,a,6,0,0,1\n1,d,9,9,9,0.5\n";
  EXPECT_EQ(refusal(read_rows, text),
            ":2: fibre 'a' has only this point, a fibre needs at least 2; skip_single_points, "
            "--skip-single-points, leaves such fibres out");
  const FiberFile file = read_text(read_rows, text, skipping());
  ASSERT_EQ(file.frames.size(), 2U);
  EXPECT_EQ(file.frames[0].names.list(2), (std::vector<std::string>{"b", "d"}));
  expect_same_fibers(file.frames[0].fibers,
                     {{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {0, 2, 4}, {1, 2, 3, 4}});
  EXPECT_EQ(file.frames[1].names.list(1), std::vector<std::string>{"a"});
  expect_same_fibers(file.frames[1].fibers, {{{5, 0, 0}, {6, 0, 0}}, {0, 2}, {1}});
  EXPECT_EQ(file.notes, std::vector<std::string>{"3 fibres of fewer than two points left out, as "
                                                 "skip_single_points says"});
}

TEST(SinglePoints, AFileOfNothingElseHasNoFibres) {
  const FiberFile file = read_text(read_rows, "x,y,z\n1,2,3\n", skipping());
  EXPECT_EQ(file.frames.at(0).fibers.fiber_count(), 0U);
}

TEST(SinglePoints, StrandsOfHairKeepTheirRadii) {
  const std::string text = Bytes()
                               .letters("HAIR")
                               .uint(3, 4)
                               .uint(4, 4)
                               .uint(7, 4)
                               .uint(0, 4)
                               .floats({0, 0, 0, 0, 0})
                               .letters(std::string(88, ' '))
                               .uint(0, 2)
                               .uint(1, 2)
                               .uint(0, 2)
                               .floats({9, 9, 9, 0, 0, 0, 1, 0, 0, 9, 9, 9})
                               .floats({8, 2, 4, 8})
                               .text();
  EXPECT_EQ(refusal(read_strands, text),
            ": strand 0 has 0 segments (byte 128), a fibre needs at least 1");
  const FiberFile file = read_text(read_strands, text, skipping());
  expect_same_fibers(file.frames.at(0).fibers, {{{0, 0, 0}, {1, 0, 0}}, {0, 2}, {1, 2}});
  EXPECT_EQ(file.notes, std::vector<std::string>{"2 fibres of fewer than two points left out, as "
                                                 "skip_single_points says"});
}

}  // namespace
}  // namespace fiber::test
