// fiber_query about fibres so small that squares of their lengths are no numbers.
#include <sstream>

#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

class TinyFibers : public ToolsTest {
 protected:
  /// The numbers of each contact.
  static std::vector<std::vector<double>> contacts(const std::string& file,
                                                   const std::string& options) {
    const ProcessResult result = query("contacts " + file + " " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<std::vector<double>> found;
    std::istringstream stream(result.out);
    std::string line;
    std::getline(stream, line);  // the header
    while (std::getline(stream, line)) {
      found.push_back(numbers_in(line));
    }
    return found;
  }
};

TEST_F(TinyFibers, NeighboursAreLeftOutByLengthAtEveryScale) {
  for (const std::string scale : {"e-320", "e-170", "e-100", "e0", "e100"}) {
    SCOPED_TRACE(scale);
    std::string text = "fiber,x,y,z,radius\n";
    for (const std::string at : {"0", "1", "2", "3", "4", "5"}) {
      text += "0," + at + scale + ",0,0,9" + scale + "\n";
    }
    const std::string file = write("line.csv", text);
    // The pairs of five segments in a row that have so many between them, and more.
    EXPECT_EQ(contacts(file, "--neighbour-skip-length 0.5" + scale).size(), 6U);
    EXPECT_EQ(contacts(file, "--neighbour-skip-length 1.5" + scale).size(), 3U);
    EXPECT_EQ(contacts(file, "--neighbour-skip-length 2.5" + scale).size(), 1U);
    EXPECT_EQ(contacts(file, "--neighbour-skip-length 3.5" + scale).size(), 0U);
    for (const std::string engine : {"brute_force", "AL", "AS"}) {
      EXPECT_EQ(
          contacts(file, "--neighbour-skip-length 1.5" + scale + " --engine " + engine).size(), 3U)
          << engine;
    }
  }
}

TEST_F(TinyFibers, NormalsAreOfUnitLength) {
  // Sides of 3 and 4 times the smallest number that there is; and where squares are less than that.
  for (const auto& [x, y] : {std::pair{"1.5e-323", "-2e-323"}, {"3e-170", "-4e-170"}}) {
    SCOPED_TRACE(x);
    const std::string point = std::string(x) + "," + y + ",0,0\n";
    const std::string file =
        write("points.csv", "fiber,x,y,z,radius\n0,0,0,0,0\n0,0,0,0,0\n1," + point + "1," + point);
    const auto found = contacts(file, "--margin 1");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].at(13), 0.6, 1e-15);
    EXPECT_NEAR(found[0].at(14), -0.8, 1e-15);
    EXPECT_EQ(found[0].at(15), 0.0);
  }
}

}  // namespace
}  // namespace fiber::test
