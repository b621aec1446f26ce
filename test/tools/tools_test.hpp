#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "src/io/number.hpp"
#include "test/support/process.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber::test {

/// A program refused: exit 2, nothing on stdout, one line on stderr that contains the reason.
inline testing::AssertionResult refused(const ProcessResult& result, const std::string& reason) {
  if (result.exit_code != 2 || !result.out.empty() ||
      std::count(result.err.begin(), result.err.end(), '\n') != 1 || result.err.back() != '\n' ||
      result.err.find(reason) == std::string::npos) {
    return testing::AssertionFailure()
           << "exit " << result.exit_code << ", stdout '" << result.out << "', stderr '"
           << result.err << "', expected a refusal with '" << reason << "'";
  }
  return testing::AssertionSuccess();
}

/// Without their ends.
inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    result.push_back(line);
  }
  return result;
}

/// The numbers of a line, between commas.
inline std::vector<double> numbers_in(const std::string& line) {
  std::vector<double> result;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    result.push_back(parse_number<double>(field).value());
  }
  return result;
}

/// Tests that run the tools that were built.
class ToolsTest : public testing::Test {
 protected:
  static ProcessResult query(const std::string& arguments) {
    return run_process(FIBER_QUERY " " + arguments);
  }
  static ProcessResult scene(const std::string& arguments) {
    return run_process(FIBER_SCENE " " + arguments);
  }

  std::string path(const std::string& name) const { return directory_.path(name); }

  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace fiber::test
