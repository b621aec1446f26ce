#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "support/source_folder.hpp"

namespace {

/// The core's modules; `ros` sits on top of them.
const char* const core_modules[] = {"geometry", "bounds", "hierarchy", "query", "io", "scenes"};

TEST(Core, IncludesNeitherRosNorFcl) {
  const std::filesystem::path source = fiber::test::source_folder();
  const std::regex forbidden(
      R"(^\s*#\s*include\s*[<"](ros|tf2?|tf2_ros|std_msgs|geometry_msgs|sensor_msgs|nav_msgs|)"
      R"(visualization_msgs|fcl|ccd|nodelet|pluginlib|fiber_proximity/ros)(/|\.h))"
      R"(|^\s*#\s*include\s*[<"]fiber_proximity/[^">]*\.h[">])");
  int files = 0;
  for (const char* folder : {"include/fiber_proximity", "src"}) {
    for (const char* module : core_modules) {
      const std::filesystem::path path = source / folder / module;
      if (!std::filesystem::exists(path)) {
        continue;
      }
      for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
        std::ifstream file(entry.path());
        ++files;
        int number = 0;
        for (std::string line; std::getline(file, line);) {
          ++number;
          EXPECT_FALSE(std::regex_search(line, forbidden))
              << entry.path() << ":" << number << ": " << line;
        }
      }
    }
  }
  EXPECT_GT(files, 20);
}

}  // namespace
