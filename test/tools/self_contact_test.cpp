// fiber_query with nothing set about neighbours: a fibre touches itself only where it makes a loop.
#include <algorithm>
#include <set>
#include <sstream>
#include <tuple>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/support/cables.hpp"
#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

using SegmentPairs = std::set<std::tuple<double, double>>;

class SelfContactOfFiles : public ToolsTest {
 protected:
  std::string write_cable(const Cable& cable) const {
    write_csv(path("cable.csv"), {false, {{0, cable.fibers()}}});
    return path("cable.csv");
  }

  /// The segments of all contacts that a subcommand prints.
  static SegmentPairs pairs(const std::string& subcommand, const std::string& file,
                            const std::string& options) {
    const ProcessResult result = query(subcommand + " " + file + " " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    SegmentPairs found;
    std::istringstream stream(result.out);
    std::string line;
    std::getline(stream, line);  // the header
    while (std::getline(stream, line)) {
      const std::vector<double> numbers = numbers_in(line);
      found.emplace(numbers.at(1), numbers.at(4));
    }
    return found;
  }
};

TEST_F(SelfContactOfFiles, CablesWithoutALoopHaveNone) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const int count : {10, 45}) {
    for (const Cable& cable : loopless_cables(count, 150.0, random)) {
      SCOPED_TRACE(cable.name);
      const std::string file = write_cable(cable);
      for (const std::string margin : {"0", "2.5", "100", "inf"}) {
        EXPECT_EQ(pairs("contacts", file, "--margin " + margin), SegmentPairs()) << margin;
      }
      EXPECT_EQ(pairs("closest", file, ""), SegmentPairs());
    }
  }
}

TEST_F(SelfContactOfFiles, StrandsThatTouchHaveThemAtEveryMargin) {
  for (const Cable& cable : {hairpin(6.2, 10), hairpin(30.0, 45), coil(2.6, 2.0, 9),
                             open_ring(4.0, 20), tight_knot(45)}) {
    SCOPED_TRACE(cable.name);
    const std::string file = write_cable(cable);
    // Rounding may part strands that touch by so much.
    SegmentPairs before = pairs("contacts", file, "--margin 1e-6");
    EXPECT_FALSE(before.empty());
    EXPECT_EQ(pairs("closest", file, "").size(), 1U);
    for (const std::string margin : {"0.5", "3", "20", "inf"}) {
      const SegmentPairs now = pairs("contacts", file, "--margin " + margin);
      EXPECT_TRUE(std::includes(now.begin(), now.end(), before.begin(), before.end())) << margin;
      before = now;
    }
  }
}

}  // namespace
}  // namespace fiber::test
