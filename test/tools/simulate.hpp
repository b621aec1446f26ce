#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/tools/tools_test.hpp"

namespace fiber::test {

class Simulate : public ToolsTest {
 protected:
  static ProcessResult simulate(const std::string& arguments) {
    return run_process(FIBER_SIMULATE " " + arguments);
  }

  /// The frames that the tool writes of a scene, and nothing else.
  std::vector<FiberFrame> frames(const std::string& scene, const std::string& options) const {
    const ProcessResult result = simulate(scene + " " + options + " --out " + path("out.csv"));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "");
    return read_csv(path("out.csv")).frames;
  }
};

}  // namespace fiber::test
