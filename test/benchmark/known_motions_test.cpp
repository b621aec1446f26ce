#include "validation/geometry/known_motions.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "test/support/temporary_directory.hpp"

namespace fiber::test {
namespace {

HardMotion some_motion() { return hard_motions(motion_families().front(), 1, 1).front(); }

TEST(KnownMotions, AreReadAsTheyAreWritten) {
  const HardMotion motion = some_motion();
  const TemporaryDirectory directory;
  const std::string path = directory.path("motions.csv");
  std::ofstream(path) << "walls,1," << coordinates_of(motion) << "\n";
  const std::vector<KnownMotion> known = read_known_motions(path);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].set, "walls");
  EXPECT_TRUE(known[0].contact);
  EXPECT_EQ(coordinates_of(known[0].motion), coordinates_of(motion));
}

TEST(KnownMotions, AreRefusedWithFileAndPlace) {
  const TemporaryDirectory directory;
  const std::string path = directory.path("motions.csv");
  const std::string good = "walls,1," + coordinates_of(some_motion());
  const auto reason = [&](const std::string& line) -> std::string {
    std::ofstream(path) << good << "\n" << line << "\n";
    try {
      read_known_motions(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(reason("walls,1,0x1p0").rfind(path + ":2: has 1 values", 0), 0U);
  const std::string doubtful = "walls,maybe," + coordinates_of(some_motion());
  EXPECT_EQ(reason(doubtful), path + ", motion 2: the truth is 'maybe', it must be 0 or 1");
  EXPECT_EQ(reason(good), "none");
  EXPECT_THROW(read_known_motions(directory.path("none.csv")), std::runtime_error);
}

}  // namespace
}  // namespace fiber::test
