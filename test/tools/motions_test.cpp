// fiber_query motions
#include <algorithm>
#include <limits>
#include <sstream>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/io/number.hpp"
#include "test/support/public_edge_motions.hpp"
#include "test/tools/tools_test.hpp"
#include "validation/geometry/hard_motions.hpp"

namespace fiber::test {
namespace {

// Two crossed segments of 1 m, of which a comes down by 2 m: from 1 m above b to 1 m below it.
const std::string ends_before = "-0.5,0,1,0.5,0,1,0,-0.5,0,0,0.5,0";
const std::string ends_after = "-0.5,0,-1,0.5,0,-1,0,-0.5,0,0,0.5,0";
const std::string falling = "crossed,1," + ends_before + "," + ends_after;
const std::string staying = "still,0," + ends_before + "," + ends_before;
const std::string no_contact = "0,1,inf,1\n";
const std::string contact_at_once = "1,0,0,1\n";

constexpr double no_end = std::numeric_limits<double>::infinity();

class Motions : public ToolsTest {
 protected:
  std::string answer(const std::string& content, const std::string& options = "") const {
    const ProcessResult result = query("motions " + write("motions.csv", content) + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }
  testing::AssertionResult refusal(const std::string& content, const std::string& reason) const {
    return refused(query("motions " + write("bad.csv", content)), path("bad.csv") + reason);
  }
};

/// A motion of a file: hit, lower, upper, certain.
std::vector<double> numbers_of(const ContactTime& time) {
  return {time.hit ? 1.0 : 0.0, time.lower, time.upper, time.certain ? 1.0 : 0.0};
}

/// The numbers of each line.
std::vector<std::vector<double>> rows_of(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.push_back(numbers_in(line));
  }
  return rows;
}

std::string row_of(const HardMotion& motion) {
  std::string row = "hard,0";
  for (const Eigen::Vector3d* ends : {motion.a_before.data(), motion.b_before.data(),
                                      motion.a_after.data(), motion.b_after.data()}) {
    for (int i = 0; i < 2; ++i) {
      for (const double coordinate : {ends[i].x(), ends[i].y(), ends[i].z()}) {
        row += ',';
        append_number(row, coordinate);
      }
    }
  }
  return row + '\n';
}

TEST_F(Motions, PrintsWhenTheyTouch) {
  const auto check_time = [this](const std::string& options, double truth, double length) {
    const std::string out = answer(falling + "\n", options);
    ASSERT_EQ(out.back(), '\n');
    const std::vector<std::vector<double>> rows = rows_of(out);
    ASSERT_EQ(rows.size(), 1U) << out;
    ASSERT_EQ(rows[0].size(), 4U) << out;
    EXPECT_EQ(rows[0][0], 1.0) << options;
    EXPECT_LE(rows[0][1], truth) << options;
    EXPECT_GE(rows[0][2], truth) << options;
    EXPECT_LE(rows[0][2] - rows[0][1], length) << options;
    EXPECT_EQ(rows[0][3], 1.0) << options;
  };
  check_time("", 0.5, 1e-6);
  check_time(" --tolerance 1e-12", 0.5, 1e-12);
  check_time(" --radius 0.125", 0.375, 1e-6);
  check_time(" --margin 0.25", 0.375, 1e-6);
  check_time(" --radius 0.125 --margin 0.25 --tolerance 1e-9", 0.25, 1e-9);
}

TEST_F(Motions, TheOptionsHaveTheirDefaults) {
  const std::string out = answer(falling);
  EXPECT_EQ(answer(falling, " --radius 0 --margin 0 --tolerance 1e-6"), out);
  EXPECT_NE(answer(falling, " --radius 1e-5"), out);
  EXPECT_NE(answer(falling, " --margin 1e-5"), out);
  EXPECT_NE(answer(falling, " --tolerance 1e-3"), out);
}

TEST_F(Motions, PrintsWhatIsNoContactAndWhatAlwaysWas) {
  EXPECT_EQ(answer(staying), no_contact);
  EXPECT_EQ(answer(staying + "\n" + staying + "\n", " --radius 0.49"), no_contact + no_contact);
  EXPECT_EQ(answer(staying, " --radius 0.5"), contact_at_once);
  EXPECT_EQ(answer(staying, " --margin 1"), contact_at_once);
  EXPECT_EQ(answer(staying, " --margin inf"), contact_at_once);
  EXPECT_EQ(answer(staying, " --margin 1e150 --radius 1e150"), contact_at_once);
}

// Segments without thickness that turn cross between two doubles.
TEST_F(Motions, AContactWhoseTimeWasNotFoundHasNoUpperBound) {
  const std::string out =
      answer("turning,1," + ends_before + ",0.3,0,-1.1,0.7,0,-0.9,0,0,0,0,1,0", " --tolerance 0");
  const std::vector<std::vector<double>> rows = rows_of(out);
  ASSERT_EQ(rows.size(), 1U) << out;
  const double lower = rows[0][1];
  EXPECT_GT(lower, 0.4);
  EXPECT_LT(lower, 0.5);
  std::string expected = "1,";
  append_number(expected, lower);
  EXPECT_EQ(out, expected + ",inf,0\n");
}

TEST_F(Motions, PrintsTheLibrarysNumbersBitForBit) {
  std::string content;
  std::vector<HardMotion> motions;
  for (const MotionFamily& family : motion_families()) {
    for (const HardMotion& motion : hard_motions(family, 20, 1)) {
      motions.push_back(motion);
      content += row_of(motion);
    }
  }
  const std::string file = write("motions.csv", content);
  std::size_t hit_count = 0;
  for (const ContactLimit& limit :
       {ContactLimit{0.0, 0.0, 0.0}, ContactLimit{0.1, 0.1, 0.0}, ContactLimit{0.0, 0.0, 0.3},
        ContactLimit{1e-3, 1e-3, no_end}}) {
    for (const double tolerance : {1e-6, 0.0}) {
      std::string command = "motions " + file + " --radius ";
      append_number(command, limit.radius_a);
      append_number(command += " --margin ", limit.margin);
      append_number(command += " --tolerance ", tolerance);
      const ProcessResult result = query(command);
      const std::vector<std::vector<double>> rows = rows_of(result.out);
      ASSERT_EQ(rows.size(), motions.size()) << command << result.err;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        SegmentMotions pair = motions[i].motions();
        pair.limit = limit;
        const ContactTime time = contact_time(pair, tolerance);
        hit_count += time.hit ? 1 : 0;
        ASSERT_EQ(rows[i], numbers_of(time)) << command << ", row " << i;
      }
    }
  }
  EXPECT_GT(hit_count, motions.size());
}

TEST_F(Motions, ReadsAllThatAFileMayBe) {
  const std::string expected = answer(falling);
  EXPECT_NE(expected, no_contact);
  std::string blanks = falling;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  std::string header = "set,truth";
  for (const char* when : {"before.", "after."}) {
    for (const char* point : {"a0", "a1", "b0", "b1"}) {
      for (const char* axis : {".x", ".y", ".z"}) {
        header += std::string(",") + when + point + axis;
      }
    }
  }
  const std::string coordinates = ends_before + "," + ends_after;
  for (const std::string& content :
       {falling + "\n", falling + "\r\n", "a set of 2 words,1," + coordinates,
        "3,0x1p-1," + coordinates, ",," + coordinates, "a,not known," + coordinates, blanks,
        " " + blanks + "\t\r\n", "a, 1, " + ends_before + " , " + ends_after + " \n",
        "a,1,-0x1p-1,+0,0X1P0,0.5,0x0p+0,1," + ends_before.substr(ends_before.find("0,-0.5")) +
            "," + ends_after,
        header + "\n" + falling, "\n \n" + header + "\n\n" + falling + "\n\n",
        "\xEF\xBB\xBF" + falling}) {
    EXPECT_EQ(answer(content), expected) << content;
  }
  EXPECT_EQ(answer(staying + "\n\n" + falling + "\r\n" + staying),
            no_contact + expected + no_contact);
  EXPECT_EQ(answer(""), "");
  EXPECT_EQ(answer("\n\r\n"), "");
  EXPECT_EQ(answer(header + "\n"), "");
}

TEST_F(Motions, RefusesBadCoordinatesNamingFileLineAndColumn) {
  const std::string rule = ", coordinates must be finite and at most 1e150 m in magnitude";
  const auto row = [](std::size_t at, const std::string& value) {
    std::string text = "a,1";
    for (std::size_t i = 0; i < 24; ++i) {
      text += "," + (i == at ? value : std::string("1"));
    }
    return text;
  };
  EXPECT_TRUE(refusal(row(0, "x"), ":1: column 3 (a0.x at t = 0) is 'x', expected a number"));
  EXPECT_TRUE(refusal(falling + "\n\n" + row(11, ""), ":3: column 14 (b1.z at t = 0) is ''"));
  EXPECT_TRUE(refusal(row(12, "nan"), ":1: column 15 (a0.x at t = 1) is 'nan'" + rule));
  EXPECT_TRUE(refusal(row(4, "inf"), ":1: column 7 (a1.y at t = 0) is 'inf'" + rule));
  EXPECT_TRUE(refusal(row(18, "-inf"), ":1: column 21 (b0.x at t = 1) is '-inf'" + rule));
  EXPECT_TRUE(refusal(row(23, "1e151"), ":1: column 26 (b1.z at t = 1) is '1e151'" + rule));
  EXPECT_TRUE(refusal(row(8, "0x1p500"), ":1: column 11 (b0.z at t = 0) is '0x1p500'" + rule));
  EXPECT_TRUE(refusal(row(23, "1e999"), ":1: column 26 (b1.z at t = 1) is '1e999'"));
  EXPECT_EQ(answer(row(0, "-1e150"), " --radius 1"), contact_at_once) << "the most there may be";
}

TEST_F(Motions, RefusesRowsThatAreTooShortOrTooLong) {
  const std::string rule =
      ", expected the 24 coordinates of a0, a1, b0 and b1 at t = 0, then at t = 1";
  const std::string coordinates = ends_before + "," + ends_after;
  EXPECT_TRUE(refusal("a\n", ":1: has 0 values after set 'a'" + rule));
  EXPECT_TRUE(
      refusal("a,1," + ends_before, ":1: has 12 values after set 'a' and truth '1'" + rule));
  EXPECT_TRUE(refusal(falling + "\n" + coordinates,
                      ":2: has 22 values after set '-0.5' and truth '0'" + rule));
  EXPECT_TRUE(refusal("a," + coordinates, ":1: has 23 values after set 'a' and truth '-0.5'"));
  EXPECT_TRUE(
      refusal(falling + ",0", ":1: has 25 values after set 'crossed' and truth '1'" + rule));
  EXPECT_TRUE(refusal(falling + ",", ":1: has 25 values"));
  EXPECT_TRUE(refusal("two,sets,1," + coordinates, ":1: has 25 values after set 'two'"));
}

TEST_F(Motions, RefusesFilesThatCannotBeRead) {
  EXPECT_TRUE(refused(query("motions " + path("none.csv")),
                      path("none.csv") + ": cannot be opened: No such file or directory"));
  EXPECT_TRUE(refused(query("motions /"), "/: cannot be read: Is a directory"));
}

TEST_F(Motions, RefusesBadCommandLines) {
  const std::string file = write("motions.csv", falling);
  EXPECT_TRUE(refused(query("motions"), "FILE"));
  EXPECT_TRUE(refused(query("motions " + file + " --kernel exact"), "--kernel"));
  const auto check_option = [&](const std::string& option, const std::string& rule,
                                const std::vector<std::string>& beyond) {
    const std::string command = "motions " + file + " --" + option;
    std::vector<std::string> values{" ",     "nan", "-nan", "-1",  "-1e-9", "-inf",
                                    "1e999", "x",   "1,5",  "1 2", "0x10",  "1m"};
    values.insert(values.end(), beyond.begin(), beyond.end());
    for (const std::string& value : values) {
      EXPECT_TRUE(refused(query(command + "='" + value + "'"),
                          "--" + option + ": '" + value + "' must be a" + rule));
    }
    for (const std::string value : {"", "-1"}) {
      EXPECT_TRUE(refused(query(command + " '" + value + "'"),
                          "--" + option + ": '" + value + "' must be a" + rule));
    }
    EXPECT_TRUE(refused(query(command), "--" + option));
    EXPECT_TRUE(refused(query(command + "="), "--" + option));
  };
  check_option("radius", " number from 0 to 1e+150\n", {"inf", "1.1e150"});
  check_option("margin", " number from 0 to 1e+150, or inf\n", {"1.1e150"});
  check_option("tolerance", " finite number from 0\n", {"inf"});
}

TEST_F(Motions, FindsThePublicCollisions) {
  const std::vector<KnownMotion> motions = public_edge_motions();
  if (motions.empty()) {
    GTEST_SKIP() << "no " << public_edge_motions_path();
  }
  const std::vector<std::vector<double>> rows =
      rows_of(query("motions " + public_edge_motions_path()).out);
  ASSERT_EQ(rows.size(), motions.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_TRUE(rows[i][0] == 1.0 || !motions[i].contact) << "row " << i;
    ASSERT_EQ(rows[i], numbers_of(contact_time(motions[i].motion.motions(), 1e-6))) << i;
  }
}

}  // namespace
}  // namespace fiber::test
