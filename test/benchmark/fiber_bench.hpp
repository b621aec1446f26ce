#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test/tools/tools_test.hpp"

namespace fiber::test {

class FiberBench : public ToolsTest {
 protected:
  static ProcessResult bench(const std::string& arguments) {
    return run_process(FIBER_BENCH " " + arguments);
  }
};

inline std::vector<nlohmann::json> json_lines(const std::string& text) {
  std::vector<nlohmann::json> result;
  for (const std::string& line : lines(text)) {
    result.push_back(nlohmann::json::parse(line));
  }
  return result;
}

}  // namespace fiber::test
