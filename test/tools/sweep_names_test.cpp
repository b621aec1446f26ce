// fiber_query sweep knows fibres again by their names.
#include <sstream>
#include <string>
#include <vector>

#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

const std::string named_header =
    "frame,fiber_a,segment_a,fiber_b,segment_b,time_lower,time_upper\n";

/// A bar along x in a frame.
std::string bar(int frame, const std::string& name, double y, double z) {
  std::ostringstream rows;
  for (const double x : {0.0, 1.0}) {
    rows << frame << ',' << name << ',' << x << ',' << y << ',' << z << ",0.01\n";
  }
  return rows.str();
}

class SweepNames : public ToolsTest {
 protected:
  std::string file(const std::string& rows) const {
    return write("bars.csv", "frame,fiber,x,y,z,radius\n" + rows);
  }
  std::string contacts(const std::string& rows, const std::string& told,
                       const std::string& options = "") const {
    const ProcessResult result = query("sweep " + file(rows) + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, told);
    EXPECT_EQ(result.out.substr(0, named_header.size()), named_header);
    return result.out.substr(std::min(result.out.size(), named_header.size()));
  }
};

std::string told(const std::string& what) {
  return "fiber_query: frames 0 and 1 have different fibres (" + what +
         "): of these only the contacts that frame 0 has itself\n";
}

TEST_F(SweepNames, TheOrderOfFibresInTheFileMakesNoMotion) {
  const std::string first = bar(0, "a", 0.0, 0.0) + bar(0, "b", 0.0, 1.0);
  EXPECT_EQ(contacts(first + bar(1, "b", 0.0, 1.0) + bar(1, "a", 0.0, 0.0), ""), "");
  EXPECT_EQ(
      contacts(bar(0, "0", 0, 0) + bar(0, "1", 0, 1) + bar(1, "1", 0, 1) + bar(1, "0", 0, 0), ""),
      "");
  // In either order b falls through a, by the names and the order of the first frame.
  const std::string falls = contacts(first + bar(1, "a", 0.0, 0.0) + bar(1, "b", 0.0, -1.0), "");
  EXPECT_EQ(falls.substr(0, 10), "0,a,0,b,0,") << falls;
  EXPECT_EQ(contacts(first + bar(1, "b", 0.0, -1.0) + bar(1, "a", 0.0, 0.0), ""), falls);
  EXPECT_EQ(contacts(first + bar(1, "b", 0.0, -1.0) + bar(1, "a", 0.0, 0.0), "", " --type first"),
            falls);
}

TEST_F(SweepNames, AFibreThatComesTakesNobodysPlace) {
  const std::string first = bar(0, "a", 0.0, 0.0) + bar(0, "b", 0.0, 1.0);
  EXPECT_EQ(
      contacts(first + bar(1, "a", 0.0, 0.0) + bar(1, "c", 0.0, -1.0), told("gone: 'b'; new: 'c'")),
      "");
  EXPECT_EQ(contacts(first + bar(1, "c", 0.0, 0.0) + bar(1, "d", 0.0, -1.0),
                     told("gone: 'a', 'b'; new: 'c', 'd'")),
            "");
  EXPECT_EQ(contacts(first + bar(1, "a", 0.0, 0.0), told("gone: 'b'")), "");
  EXPECT_EQ(contacts(first + bar(1, "c", 0.0, 5.0) + bar(1, "b", 0.0, 1.0) + bar(1, "a", 0.0, 0.0),
                     told("new: 'c'")),
            "");
}

// Fibres that are in both frames are still swept: a falls through b; c, which goes, touched d and
// would be in the way of e; f, of other points, touched d as well.
TEST_F(SweepNames, OfFibresThatGoTheContactsOfTheFrameItself) {
  const std::string first = bar(0, "c", 3.0, 0.0) + bar(0, "a", 0.0, 1.0) + bar(0, "b", 0.0, 0.0) +
                            bar(0, "d", 3.015, 0.0) + bar(0, "e", 3.0, 1.0) +
                            bar(0, "f", 3.03, 0.0);
  const std::string second = bar(1, "e", 3.0, -1.0) + bar(1, "d", 9.0, 0.0) +
                             bar(1, "b", 0.0, 0.0) + bar(1, "f", 3.03, 0.0) +
                             "1,f,2,3.03,0,0.01\n" + bar(1, "a", 0.0, -1.0) + bar(1, "g", 0.0, 0.0);
  const std::string what = told("gone: 'c'; of other numbers of points: 'f'; new: 'g'");
  const std::vector<std::string> rows = lines(contacts(first + second, what));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], "0,c,0,d,0,0,0");
  EXPECT_EQ(rows[1].substr(0, 10), "0,a,0,b,0,");
  EXPECT_EQ(rows[2], "0,d,0,f,0,0,0");
  const std::vector<double> times = numbers_in(rows[1].substr(10));
  EXPECT_NEAR(times[0], 0.49, 1e-5) << "while it moves";
  EXPECT_EQ(lines(contacts(first + second, what, " --new-only")),
            std::vector<std::string>{rows[1]});
  EXPECT_EQ(lines(contacts(first + second, what, " --type first")),
            std::vector<std::string>{rows[0]});
  EXPECT_EQ(lines(contacts(first + second, what, " --type first --new-only")),
            std::vector<std::string>{rows[1]});
  for (const std::string engine : {"AL", "brute_force"}) {
    EXPECT_EQ(lines(contacts(first + second, what, " --engine " + engine)), rows);
  }
}

TEST_F(SweepNames, ManyThatDifferAreCounted) {
  std::string rows = bar(0, "stays", 0.0, 0.0);
  for (const std::string name : {"a", "b", "c", "d", "e"}) {
    rows += bar(0, name, 1.0, 0.0);
  }
  EXPECT_EQ(contacts(rows + bar(1, "stays", 0.0, 0.0), told("gone: 'a', 'b', 'c' and 2 more"),
                     " --new-only"),
            "");
}

}  // namespace
}  // namespace fiber::test
