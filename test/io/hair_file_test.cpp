// Reading .hair files.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/io/hair_bytes.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

constexpr std::uint32_t segments_flag = 1;
constexpr std::uint32_t points_flag = 2;
constexpr std::uint32_t thickness_flag = 4;
constexpr std::uint32_t transparency_flag = 8;
constexpr std::uint32_t color_flag = 16;

std::string header(std::uint32_t strands, std::uint32_t points, std::uint32_t flags,
                   std::uint32_t default_segments = 2, float default_thickness = 0.5F) {
  Bytes bytes;
  bytes.letters("HAIR").uint(strands, 4).uint(points, 4).uint(flags, 4).uint(default_segments, 4);
  bytes.floats({default_thickness, 0.25F, 1.0F, 0.5F, 0.0F}).letters(std::string(88, 'i'));
  return bytes.text();
}

/// Two strands of 2 and 2 segments, or with a segments array of 1 and 3; point i is (i, −i, i/2).
std::string sample(std::uint32_t flags) {
  Bytes bytes;
  bytes.letters(header(2, 6, flags));
  if ((flags & segments_flag) != 0) {
    bytes.uint(1, 2).uint(3, 2);
  }
  for (int i = 0; i < 6; ++i) {
    const auto x = static_cast<float>(i);
    bytes.floats({x, -x, 0.5F * x});
  }
  if ((flags & thickness_flag) != 0) {
    bytes.floats({1, 2, 3, 4, 5, 6});
  }
  if ((flags & transparency_flag) != 0) {
    bytes.floats(std::vector<float>(6, 9.0F));
  }
  if ((flags & color_flag) != 0) {
    bytes.floats(std::vector<float>(18, 8.0F));
  }
  return bytes.text();
}

std::string hair_refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

std::string with(std::string text, std::size_t at, const Bytes& bytes) {
  return text.replace(at, bytes.text().size(), bytes.text());
}

TEST(ReadHair, EveryCombinationOfArrays) {
  for (std::uint32_t flags = 0; flags < 32; ++flags) {
    if ((flags & points_flag) == 0) {
      continue;
    }
    SCOPED_TRACE(flags);
    const FiberFile file = parse(sample(flags));
    EXPECT_FALSE(file.has_frames);
    ASSERT_EQ(file.frames.size(), 1U);
    const FiberAssembly& fibers = file.frames[0].fibers;
    const bool has_segments = (flags & segments_flag) != 0;
    EXPECT_EQ(fibers.offsets(), has_segments ? (Offsets{0, 2, 6}) : (Offsets{0, 3, 6}));
    ASSERT_EQ(fibers.point_count(), 6U);
    for (int i = 0; i < 6; ++i) {
      EXPECT_EQ(fibers.points()[static_cast<std::size_t>(i)], Eigen::Vector3d(i, -i, 0.5 * i));
    }
    const bool has_thickness = (flags & thickness_flag) != 0;
    EXPECT_EQ(fibers.radii(), has_thickness ? (Radii{0.5, 1, 1.5, 2, 2.5, 3}) : Radii{0.25});
  }
}

TEST(ReadHair, DefaultRadiusServesFilesWithoutThickness) {
  const auto radii = [](float thickness) {
    return fibers_of(
               header(1, 2, points_flag, 1, thickness) + Bytes().floats({0, 0, 0, 1, 0, 0}).text(),
               0.125)
        .radii();
  };
  EXPECT_EQ(radii(0.0F), Radii{0.125});
  EXPECT_EQ(radii(0.5F), Radii{0.25});
  EXPECT_EQ(fibers_of(sample(points_flag | thickness_flag), 0.125).radii().size(), 6U);
  EXPECT_THROW(parse(sample(points_flag), -1.0), std::invalid_argument);
}

TEST(ReadHair, OneRadiusServesEqualThicknesses) {
  const std::string text = header(1, 2, points_flag | thickness_flag, 1) +
                           Bytes().floats({0, 0, 0, 1, 0, 0, 3, 3}).text();
  EXPECT_EQ(fibers_of(text).radii(), Radii{1.5});
}

TEST(ReadHair, AcceptsAFileOfNoStrands) {
  for (const std::uint32_t flags : {2U, 31U}) {
    const FiberAssembly fibers = fibers_of(header(0, 0, flags));
    EXPECT_EQ(fibers.fiber_count(), 0U);
  }
}

TEST(ReadHair, RefusesWhatIsNotAHairFile) {
  EXPECT_EQ(hair_refusal(""), "a.hair: ends at byte 0");
  EXPECT_EQ(hair_refusal("HAI"), "a.hair: ends at byte 3");
  EXPECT_EQ(hair_refusal("fiber,x,y,z\n"),
            "a.hair: is not a HAIR file, which begins with the letters HAIR");
  EXPECT_EQ(hair_refusal(sample(points_flag).substr(0, 100)), "a.hair: ends at byte 100");
}

TEST(ReadHair, RefusesFlagsItCannotFollow) {
  EXPECT_EQ(hair_refusal(header(2, 6, 0)),
            "a.hair: the flags (byte 12) are 0, without the points (2) there are no fibres");
  EXPECT_EQ(hair_refusal(header(2, 6, 29)),
            "a.hair: the flags (byte 12) are 29, without the points (2) there are no fibres");
  EXPECT_EQ(hair_refusal(header(2, 6, 34)),
            "a.hair: the flags (byte 12) are 34, only those up to 31 have a meaning");
}

TEST(ReadHair, RefusesCountsThatDoNotFitTheFile) {
  const std::string text = sample(points_flag);
  EXPECT_EQ(hair_refusal(with(text, 8, Bytes().uint(7, 4))),
            "a.hair: has 200 bytes, the header asks for 212: 2 strands (byte 4), 7 points (byte 8),"
            " flags 2 (byte 12)");
  EXPECT_EQ(hair_refusal(text + "x"),
            "a.hair: has 201 bytes, the header asks for 200: 2 strands (byte 4), 6 points (byte 8),"
            " flags 2 (byte 12)");
  // Counts that would need gigabytes, in fields where 32 bits would overflow.
  EXPECT_EQ(hair_refusal(header(0xffff'ffffU, 0x7fff'ffffU, 31)),
            "a.hair: has 128 bytes, the header asks for 77309411422: 4294967295 strands (byte 4),"
            " 2147483647 points (byte 8), flags 31 (byte 12)");
  EXPECT_EQ(hair_refusal(header(1, 0x8000'0000U, 2)),
            "a.hair: the number of points (byte 8) is 2147483648, at most 2147483647 are"
            " supported");
}

TEST(ReadHair, RefusesStrandsThatDoNotFitThePoints) {
  EXPECT_EQ(hair_refusal(with(sample(3), 130, Bytes().uint(4, 2))),
            "a.hair: strand 1 has 4 segments (byte 130) and would end with point 7 of 6 (byte 8)");
  EXPECT_EQ(hair_refusal(with(sample(3), 128, Bytes().uint(0xffff, 2))),
            "a.hair: strand 0 has 65535 segments (byte 128) and would end with point 65536 of 6"
            " (byte 8)");
  EXPECT_EQ(hair_refusal(with(sample(3), 130, Bytes().uint(2, 2))),
            "a.hair: the strands have 5 points, the header says 6 (byte 8)");
  EXPECT_EQ(hair_refusal(with(sample(2), 16, Bytes().uint(0xffff'ffffU, 4))),
            "a.hair: strand 0 has 4294967295 segments (byte 16) and would end with point"
            " 4294967296 of 6 (byte 8)");
  EXPECT_EQ(hair_refusal(with(sample(2), 4, Bytes().uint(0xffff'ffffU, 4))),
            "a.hair: strand 2 has 2 segments (byte 16) and would end with point 9 of 6 (byte 8)");
}

TEST(ReadHair, RefusesAStrandWithoutSegments) {
  EXPECT_EQ(hair_refusal(with(sample(3), 130, Bytes().uint(0, 2))),
            "a.hair: strand 1 has 0 segments (byte 130), a fibre needs at least 1");
  EXPECT_EQ(hair_refusal(with(sample(2), 16, Bytes().uint(0, 4))),
            "a.hair: strand 0 has 0 segments (byte 16), a fibre needs at least 1");
}

TEST(ReadHair, RefusesBadNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::string coordinates = FiberAssembly::coordinate_rule;
  const std::string radii = FiberAssembly::radius_rule;
  EXPECT_EQ(hair_refusal(with(sample(2), 128 + 12 + 4, Bytes().floats({nan}))),
            "a.hair: y of point 1 (byte 144) is nan, " + coordinates);
  EXPECT_EQ(hair_refusal(with(sample(6), 200 + 8, Bytes().floats({-1}))),
            "a.hair: the thickness of point 2 (byte 208) is -1, " + radii);
  EXPECT_EQ(hair_refusal(with(sample(2), 20, Bytes().floats({infinity}))),
            "a.hair: the default thickness (byte 20) is inf, " + radii);
  EXPECT_EQ(hair_refusal(with(sample(6), 20, Bytes().floats({nan}))), "accepted")
      << "it serves nobody";
}

TEST(ReadHair, ATruncatedFileIsAnErrorAtEveryLength) {
  for (const std::uint32_t flags : {2U, 3U, 6U, 31U}) {
    const std::string text = sample(flags);
    for (std::size_t size = 0; size < text.size(); ++size) {
      EXPECT_THROW(parse(text.substr(0, size)), FileError) << flags << ", " << size;
    }
  }
}

TEST(ReadHair, AWrongBitIsReadOrRefusedAndNothingElse) {
  for (const std::uint32_t flags : {2U, 3U, 6U, 31U}) {
    const std::string text = sample(flags);
    for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
      std::string changed = text;
      changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << (bit % 8)));
      SCOPED_TRACE(testing::Message() << "flags " << flags << ", bit " << bit);
      const std::string answer = hair_refusal(changed);  // any other exception fails the test
      if (bit < std::size_t{8} * 16) {
        EXPECT_NE(answer, "accepted") << "signature, counts and flags decide the size";
      }
    }
  }
}

TEST(ReadHair, RandomFieldsAreReadOrRefusedAndNothingElse) {
  SCOPED_TRACE(test::seed_message());
  test::Random random;
  for (int trial = 0; trial < 20'000; ++trial) {
    std::string text = sample(static_cast<std::uint32_t>(random.integer(0, 31)) | points_flag);
    for (int change = random.integer(1, 3); change > 0; --change) {
      const auto word = static_cast<std::size_t>(random.integer(1, 40));
      const std::uint32_t value = random.chance(0.5)
                                      ? static_cast<std::uint32_t>(random.integer(0, 8))
                                      : static_cast<std::uint32_t>(random.integer(-3, 0x7fff'ffff));
      text = with(text, 4 * word, Bytes().uint(value, 4));
    }
    hair_refusal(text);
  }
}

TEST(ReadHair, NamesAFileThatCannotBeRead) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      read_hair(path);
    } catch (const FileError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message("/no/such/a.hair"),
            "/no/such/a.hair: cannot be opened: No such file or directory");
  EXPECT_EQ(message("/"), "/: cannot be read: Is a directory");
  EXPECT_EQ(message("/dev/null"), "/dev/null: ends at byte 0");
}

}  // namespace
}  // namespace fiber::test
