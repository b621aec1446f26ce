// .trk files, written byte by byte as TrackVis's documentation tells.
#include <limits>

#include "src/io/fiber_formats.hpp"
#include "test/io/format.hpp"

namespace fiber::test {
namespace {

/// Holds the fields of a header that tests change.
struct TrkHeader {
  std::vector<std::string> scalars{};
  std::vector<std::string> properties{};
  std::vector<float> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::string order = "RAS";
  std::vector<float> voxel_size{1, 1, 1};
  std::int32_t tracks = 0;
  ByteOrder bytes = ByteOrder::LITTLE;
};

std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

std::string names_field(const std::vector<std::string>& names) {
  std::string field;
  for (const std::string& name : names) {
    field += padded(name, 20);
  }
  return padded(field, 200);
}

std::string trk_header(const TrkHeader& header) {
  return Bytes(header.bytes)
      .letters(padded("TRACK", 6))
      .uint(10, 2)
      .uint(20, 2)
      .uint(30, 2)
      .floats(header.voxel_size)
      .floats({0, 0, 0})
      .uint(header.scalars.size(), 2)
      .letters(names_field(header.scalars))
      .uint(header.properties.size(), 2)
      .letters(names_field(header.properties))
      .floats(header.matrix)
      .letters(std::string(444, '\0'))
      .letters(padded(header.order, 4))
      .letters(std::string(36, '\0'))
      .uint(static_cast<std::uint32_t>(header.tracks), 4)
      .uint(2, 4)
      .uint(1000, 4)
      .text();
}

/// Two tracks of 2 and 3 points, with all that the header announces.
std::string trk_sample(const TrkHeader& header = {}) {
  Bytes bytes(header.bytes);
  bytes.letters(trk_header(header));
  float number = 1.0F;
  for (const std::uint32_t points : {2U, 3U}) {
    bytes.uint(points, 4);
    for (std::uint32_t point = 0; point < points; ++point, number += 1.0F) {
      bytes.floats({number, 2 * number, 0.5F})
          .floats(std::vector<float>(header.scalars.size(), 250 * number));
    }
    bytes.floats(std::vector<float>(header.properties.size(), 7.0F));
  }
  return bytes.text();
}

std::string trk_refusal(const std::string& text) { return refusal(read_trk, text); }

TEST(ReadTrk, PointsCountFromTheCornerOfAVoxel) {
  for (const ByteOrder order : {ByteOrder::LITTLE, ByteOrder::BIG}) {
    for (const std::int32_t count : {0, 2}) {
      TrkHeader header;
      header.bytes = order;
      header.tracks = count;
      const FiberFile file = read_text(read_trk, trk_sample(header), 0.25);
      EXPECT_TRUE(file.notes.empty());
      const FiberAssembly& fibers = file.frames.at(0).fibers;
      EXPECT_EQ(fibers.offsets(), (std::vector<std::uint32_t>{0, 2, 5}));
      EXPECT_EQ(fibers.points()[0], Eigen::Vector3d(0.0005, 0.0015, 0.0));
      EXPECT_EQ(fibers.points()[4], Eigen::Vector3d(0.0045, 0.0095, 0.0));
      EXPECT_EQ(fibers.radii(), std::vector<double>{0.25});
    }
  }
}

TEST(ReadTrk, TheMatrixLeadsToTheSpaceOfTheScanner) {
  TrkHeader header;
  header.voxel_size = {2, 4, 0.5F};
  header.matrix = {0, -4, 0, 10, 2, 0, 0, 20, 0, 0, 0.5F, -30, 0, 0, 0, 1};
  header.order = "ALS";  // the first axis of voxels leads to A, the second to L
  const auto first_point = [&] {
    return read_text(read_trk, trk_sample(header)).frames.at(0).fibers.points()[0];
  };
  // (1, 2, 0.5) mm is voxel (0, 0, 0.5).
  EXPECT_EQ(first_point(), Eigen::Vector3d(0.01, 0.02, -0.02975));
  // Its second axis the other way round, of 20 voxels: voxel 19 instead of 0.
  header.order = "ARS";
  EXPECT_EQ(first_point(), Eigen::Vector3d(-0.066, 0.02, -0.02975));
  // Its axes in another order: x of the file goes along the second axis of the matrix.
  header.order = "LAS";
  header.voxel_size = {4, 2, 0.5F};
  // Voxel (-0.25, 0.5, 0.5) of the file is (0.5, -0.25, 0.5) of the matrix.
  EXPECT_EQ(first_point(), Eigen::Vector3d(0.011, 0.021, -0.02975));
  // Without an order, LPS.
  header.order = "LPS";
  const Eigen::Vector3d as_told = first_point();
  header.order = "";
  EXPECT_EQ(first_point(), as_told);
}

TEST(ReadTrk, WithoutAMatrixPointsStayWhereTheyAre) {
  TrkHeader header;
  header.matrix = std::vector<float>(16, 0.0F);
  header.order = "LPS";
  const FiberFile file = read_text(read_trk, trk_sample(header));
  EXPECT_EQ(file.frames.at(0).fibers.points()[0], Eigen::Vector3d(0.001, 0.002, 0.0005));
  EXPECT_EQ(file.notes,
            std::vector<std::string>{
                "there is no vox_to_ras: coordinates count from the corner of the first voxel"});
}

TEST(ReadTrk, ScalarsAndPropertiesAreToldAndRadiiRead) {
  TrkHeader header;
  header.scalars = {"fa", "Radius", "md"};
  header.properties = {"length"};
  const FiberFile file = read_text(read_trk, trk_sample(header));
  EXPECT_EQ(file.notes, (std::vector<std::string>{"scalars not read: 'fa', 'md'",
                                                  "properties not read: 'length'"}));
  EXPECT_EQ(file.frames.at(0).fibers.points()[4], Eigen::Vector3d(0.0045, 0.0095, 0.0));
  EXPECT_EQ(file.frames.at(0).fibers.radii(), (std::vector<double>{0.25, 0.5, 0.75, 1.0, 1.25}));
}

TEST(ReadTrk, WhatIsWrittenIsReadAsTheSameInSinglePrecision) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    const FiberAssembly fibers = random_fibers(random);
    std::stringstream stream;
    write_trk(stream, {false, {{0, fibers}}});
    const FiberFile again = read_trk(stream, "a");
    EXPECT_TRUE(again.notes.empty());
    if (fibers.fiber_count() > 0) {
      expect_same_fibers(again.frames.at(0).fibers, in_float_millimetres(fibers, true));
    }
  }
}

TEST(ReadTrk, RefusesHeadersItCannotFollow) {
  EXPECT_EQ(trk_refusal(""),
            ": is not a .trk file, which begins with the letters TRACK and a zero");
  EXPECT_EQ(trk_refusal(trk_sample().substr(0, 999)), ": ends at byte 999");
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 996, Bytes().uint(999, 4).text())),
            ": the size of the header (byte 996) is not 1000, in neither order of bytes");
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 36, Bytes().uint(0xffff, 2).text())),
            ": the number of scalars (byte 36) is -1, expected 0 to 10");
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 238, Bytes().uint(11, 2).text())),
            ": the number of properties (byte 238) is 11, expected 0 to 10");
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 12, Bytes().floats({0}).text())),
            ": the voxel_size (byte 12) is 0 1 1, expected three numbers above 0");
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 440 + 60, Bytes().floats({2}).text())),
            ": the matrix vox_to_ras (byte 440) is no affine one: finite, with 0 0 0 1 as its last "
            "row");
  TrkHeader header;
  for (const std::string order : {"RAR", "RAX", "RA", "RASS"}) {
    header.order = order;
    EXPECT_EQ(trk_refusal(trk_sample(header)),
              ": the voxel_order (byte 948) is '" + order +
                  "', expected one of L and R, of A and P, and of I and S");
  }
  header = {};
  header.tracks = -1;
  EXPECT_EQ(trk_refusal(trk_sample(header)), ": the number of tracks (byte 988) is -1");
}

TEST(ReadTrk, RefusesWhatTheTracksShouldNotBe) {
  TrkHeader header;
  header.tracks = 1;
  EXPECT_EQ(trk_refusal(trk_sample(header)),
            ": has 40 bytes after 1 tracks, as many as the header tells of (byte 988)");
  header.tracks = 3;
  EXPECT_EQ(trk_refusal(trk_sample(header)), ": ends at byte 1068");
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 1000, Bytes().uint(0x7fff'ffff, 4).text())),
            ": track 0 (byte 1000) has 2147483647 points, the file has 64 more bytes");
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 1000, Bytes().uint(0xffff'fffe, 4).text())),
            ": track 0 (byte 1000) has -2 points, the file has 64 more bytes");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(trk_refusal(replaced(trk_sample(), 1020, Bytes().floats({nan}).text())),
            ": y of point 1 of track 0 (byte 1020) is nan, " +
                std::string(FiberAssembly::coordinate_rule));
  header.tracks = 2;
  header.scalars = {"radius"};
  EXPECT_EQ(trk_refusal(replaced(trk_sample(header), 1016, Bytes().floats({-1}).text())),
            ": the radius of point 0 of track 0 (byte 1016) is -0.001, " +
                std::string(FiberAssembly::radius_rule));
  expect_truncations_refused(read_trk, trk_sample(header));
  expect_wrong_bits_read_or_refused(read_trk, trk_sample(header));
}

}  // namespace
}  // namespace fiber::test
