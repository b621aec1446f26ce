// .tck files, written byte by byte as MRtrix's documentation tells.
#include <limits>

#include "src/io/fiber_formats.hpp"
#include "test/io/format.hpp"

namespace fiber::test {
namespace {

const float tck_nan = std::numeric_limits<float>::quiet_NaN();
const float tck_end = std::numeric_limits<float>::infinity();

/// The header of tracks that begin at byte 100.
std::string tck_header(const std::string& fields) {
  const std::string text = "mrtrix tracks\n" + fields + "file: . 100\nEND\n";
  return text + std::string(100 - text.size(), '#');
}

std::string tck_sample(const std::string& fields = "datatype: Float32LE\ncount: 2\n") {
  return Bytes()
      .letters(tck_header(fields))
      .floats({1, 2, 3, 4, 5, 6.5F, tck_nan, tck_nan, tck_nan})
      .floats({7, 8, 9, -1, 0, 1, 2, 2, 2, tck_nan, tck_nan, tck_nan, tck_end, tck_end, tck_end})
      .text();
}

std::string tck_refusal(const std::string& text, const ReadOptions& options = {}) {
  return refusal(read_tck, text, options);
}

TEST(ReadTck, MillimetresBecomeMetres) {
  const FiberFile file = read_text(read_tck, tck_sample(), 0.125);
  EXPECT_FALSE(file.has_frames);
  EXPECT_TRUE(file.notes.empty());
  const FiberAssembly& fibers = file.frames.at(0).fibers;
  EXPECT_EQ(fibers.offsets(), (std::vector<std::uint32_t>{0, 2, 5}));
  EXPECT_EQ(fibers.points()[1], Eigen::Vector3d(0.004, 0.005, 0.0065));
  EXPECT_EQ(fibers.points()[4], Eigen::Vector3d(0.002, 0.002, 0.002));
  EXPECT_EQ(fibers.radii(), std::vector<double>{0.125});
}

TEST(ReadTck, EveryNumberAndOrderOfBytes) {
  const FiberAssembly expected = read_text(read_tck, tck_sample()).frames.at(0).fibers;
  const std::vector<double> numbers{
      1,  2, 3, 4, 5, 6.5, tck_nan, tck_nan, tck_nan, 7,       8,       9,
      -1, 0, 1, 2, 2, 2,   tck_nan, tck_nan, tck_nan, tck_end, tck_end, tck_end};
  for (const ByteOrder order : {ByteOrder::LITTLE, ByteOrder::BIG}) {
    const std::string end = order == ByteOrder::BIG ? "BE" : "LE";
    const auto points_of = [](const std::string& text) {
      return read_text(read_tck, text).frames.at(0).fibers.points();
    };
    EXPECT_EQ(points_of(Bytes(order)
                            .letters(tck_header("datatype: Float64" + end + "\n"))
                            .doubles(numbers)
                            .text()),
              expected.points());
    EXPECT_EQ(points_of(Bytes(order)
                            .letters(tck_header("datatype: Float32" + end + "\n"))
                            .floats({numbers.begin(), numbers.end()})
                            .text()),
              expected.points());
  }
}

TEST(ReadTck, WhatIsWrittenIsReadAsTheSameInSinglePrecision) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    const FiberAssembly fibers = random_fibers(random);
    std::stringstream stream;
    write_tck(stream, {false, {{0, fibers}}});
    const FiberFile again = read_tck(stream, "a");
    EXPECT_TRUE(again.notes.empty());
    expect_same_fibers(again.frames.at(0).fibers, in_float_millimetres(fibers, false));
  }
}

TEST(ReadTck, TracksOfOnePointAreSkippedOrRefused) {
  const std::string text = Bytes()
                               .letters(tck_header("datatype: Float32LE\ncount: 3\n"))
                               .floats({1, 2, 3, tck_nan, tck_nan, tck_nan})
                               .floats({1, 2, 3, 4, 5, 6, tck_nan, tck_nan, tck_nan})
                               .floats({tck_nan, tck_nan, tck_nan, tck_end, tck_end, tck_end})
                               .text();
  EXPECT_EQ(tck_refusal(text),
            ": track 0 has 1 point, a fibre needs at least 2; skip_single_points, "
            "--skip-single-points, leaves such fibres out");
  ReadOptions options;
  options.skip_single_points = true;
  const FiberFile file = read_text(read_tck, text, options);
  EXPECT_EQ(file.frames.at(0).fibers.offsets(), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(file.frames.at(0).fibers.points().front(), Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(file.notes, std::vector<std::string>{"2 fibres of fewer than two points left out, as "
                                                 "skip_single_points says"});
}

TEST(ReadTck, RefusesHeadersItCannotFollow) {
  EXPECT_EQ(tck_refusal(""), ": is not a .tck file, which begins with 'mrtrix tracks'");
  EXPECT_EQ(tck_refusal("mrtrix tracks\ndatatype: Float32LE\n"), ": the header has no line END");
  EXPECT_EQ(tck_refusal("mrtrix tracks\nfile: . 9\nEND\n"), ": the header has no field datatype");
  EXPECT_EQ(tck_refusal("mrtrix tracks\ndatatype: Float32LE\nEND\n"),
            ": the header has no field file");
  EXPECT_EQ(tck_refusal(tck_sample("datatype: Float32\n")),
            ":2: datatype is 'Float32', expected Float32LE, Float32BE, Float64LE or Float64BE");
  EXPECT_EQ(tck_refusal(tck_sample("datatype: Float32LE\ncount: many\n")),
            ":3: count is 'many', expected a whole number");
  EXPECT_EQ(tck_refusal("mrtrix tracks\ndatatype: Float32LE\nfile: other.dat 0\nEND\n"),
            ":3: file is 'other.dat 0', expected a point and the byte where the tracks begin");
  for (const std::string byte : {"9", "99", "18446744073709551615"}) {
    EXPECT_EQ(tck_refusal("mrtrix tracks\ndatatype: Float32LE\nfile: . " + byte + "\nEND\n"),
              ": the field file says that the tracks begin at byte " + byte +
                  ", the header ends at " + std::to_string(47 + byte.size()) + " and the file at " +
                  std::to_string(47 + byte.size()));
  }
}

TEST(ReadTck, RefusesWhatTheTracksShouldNotBe) {
  EXPECT_EQ(tck_refusal(tck_sample("datatype: Float32LE\ncount: 3\n")),
            ": the header's count is 3, there are 2 tracks");
  EXPECT_EQ(tck_refusal(tck_sample("datatype: Float32LE\ncount: 0000000000\n")), "accepted");
  EXPECT_EQ(tck_refusal(replaced(tck_sample(), 100 + 4, Bytes().floats({tck_nan}).text())),
            ": y of point 0 of track 0 (byte 104) is nan, " +
                std::string(FiberAssembly::coordinate_rule));
  EXPECT_EQ(tck_refusal(replaced(tck_sample(), 100 + 44, Bytes().floats({tck_end}).text())),
            ": z of point 0 of track 1 (byte 144) is inf, " +
                std::string(FiberAssembly::coordinate_rule));
  expect_truncations_refused(read_tck, tck_sample());
  EXPECT_EQ(tck_refusal(tck_sample().substr(0, 190)),
            ": ends at byte 190, without the three infinities that end the tracks");
  EXPECT_EQ(read_text(read_tck, tck_sample() + "xyz").notes,
            std::vector<std::string>{"3 bytes after the end of the tracks are not read"});
  expect_wrong_bits_read_or_refused(read_tck, tck_sample());
}

TEST(WriteTck, RefusesWhatItCannotHold) {
  std::ostringstream stream;
  EXPECT_THROW(write_tck(stream, {true, {{3, FiberAssembly()}}}), std::invalid_argument);
  EXPECT_THROW(write_tck(stream, {false, {}}), std::invalid_argument);
  EXPECT_THROW(write_tck(stream, {false, {{0, {{{1e36, 0, 0}, {0, 0, 0}}, {0, 2}, {0.0}}}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace fiber::test
