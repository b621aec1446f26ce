// Writing .hair files.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "test/io/hair_bytes.hpp"

namespace fiber::test {
namespace {

std::string written(const FiberAssembly& fibers) {
  std::ostringstream stream;
  write_hair(stream, {false, {{0, fibers}}});
  return stream.str();
}

/// Numbers that single precision holds, or else a round trip would not be the same.
FiberAssembly assembly(const Offsets& offsets, Radii radii) {
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = 0; i < offsets.back(); ++i) {
    points.emplace_back(0.25 * i, -1e30F, static_cast<double>(0.1F));
  }
  return {points, offsets, std::move(radii)};
}

TEST(WriteHair, ReadsBackAsTheSameFibers) {
  for (const Offsets& offsets :
       {Offsets{0, 3, 6}, Offsets{0, 2, 6}, Offsets{0, 4, 6}, Offsets{0, 70'000, 140'000}}) {
    const Radii per_point(offsets.back(), 0.5);
    Radii tapered = per_point;
    tapered.back() = 0.25;
    for (const Radii& radii : {Radii{0.0}, Radii{0.5}, Radii{0.5, 0.125}, tapered}) {
      SCOPED_TRACE(testing::Message() << offsets[1] << ", " << radii.size());
      const FiberAssembly fibers = assembly(offsets, radii);
      const FiberAssembly again = fibers_of(written(fibers));
      EXPECT_EQ(again.points(), fibers.points());
      EXPECT_EQ(again.offsets(), fibers.offsets());
      for (std::uint32_t fiber = 0; fiber < 2; ++fiber) {
        for (std::uint32_t i = offsets[fiber]; i + 1 < offsets[fiber + 1]; ++i) {
          ASSERT_EQ(again.segment_radius(i), fibers.segment_radius(i)) << i;
        }
      }
    }
  }
  EXPECT_EQ(fibers_of(written(FiberAssembly())).fiber_count(), 0U);
}

TEST(WriteHair, WritesTheFormatByteForByte) {
  const std::string text =
      written({{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0, 0, 1}, {0, 0, 2}}, {0, 2, 5}, {0.5, 1.5}});
  EXPECT_EQ(text.substr(0, 40), Bytes()
                                    .letters("HAIR")
                                    .uint(2, 4)
                                    .uint(5, 4)
                                    .uint(7, 4)
                                    .uint(0, 4)
                                    .floats({0, 0, 1, 1, 1})
                                    .text());
  EXPECT_EQ(text.substr(128), Bytes()
                                  .uint(1, 2)
                                  .uint(2, 2)
                                  .floats({1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 1, 0, 0, 2})
                                  .floats({1, 1, 3, 3, 3})
                                  .text());
  const std::string uniform = written({{{1, 2, 3}, {4, 5, 6}}, {0, 2}, {0.25}});
  EXPECT_EQ(uniform.substr(4, 20),
            Bytes().uint(1, 4).uint(2, 4).uint(2, 4).uint(1, 4).floats({0.5}).text());
}

TEST(WriteHair, RoundsToSinglePrecision) {
  const FiberAssembly again = fibers_of(written({{{0.1, 0, 0}, {1, 0, 0}}, {0, 2}, {3.5e-5}}));
  EXPECT_EQ(again.points()[0].x(), static_cast<double>(0.1F));
  EXPECT_EQ(again.radii(), Radii{0.5 * static_cast<double>(7e-5F)});
}

TEST(WriteHair, RefusesWhatAFileCannotHold) {
  const auto message = [](const FiberFile& file) -> std::string {
    std::ostringstream stream;
    try {
      write_hair(stream, file);
    } catch (const std::invalid_argument& error) {
      EXPECT_TRUE(stream.str().empty());
      return error.what();
    }
    return "accepted";
  };
  const std::string refused = "a .hair file cannot hold this: ";
  const FiberAssembly fibers = assembly({0, 2}, {0.5});
  EXPECT_EQ(message({false, {}}), refused + "it holds exactly 1 frame without a number, not 0");
  EXPECT_EQ(message({true, {{3, fibers}}}),
            refused + "it holds exactly 1 frame without a number, not 1 with numbers");
  EXPECT_EQ(message({false, {{0, assembly({0, 2, 70'002}, {0.5})}}}),
            refused + "fibre 1 has 69999 segments, more than 65535 and not as many as the others");
  EXPECT_EQ(message({false, {{0, {{{0, 0, 0}, {0, 1e39, 0}}, {0, 2}, {0.0}}}}}),
            refused + "fibre 0, point 1: y is 1e+39, beyond single precision");
  EXPECT_EQ(message({false, {{0, {{{0, 0, 0}, {0, 1, 0}}, {0, 2}, {0.0, 2e38}}}}}),
            refused + "fibre 0, point 1: the thickness is 4e+38, beyond single precision");
}

TEST(WriteHair, NamesAFileThatCannotBeWritten) {
  const FiberFile file{false, {{0, assembly({0, 2}, {0.5})}}};
  EXPECT_THROW(write_hair("/no/such/place/a.hair", file), FileError);
  EXPECT_THROW(write_hair("/dev/full", file), FileError);
}

}  // namespace
}  // namespace fiber::test
