#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "support/source_folder.hpp"

namespace {

/// Folders whose includes must be free of ROS, and those of them that may include FCL.
const std::set<std::string> modules{"bounds",    "compare", "environment", "geometry",
                                    "hierarchy", "io",      "query",       "scenes",
                                    "sim",       "text",    "tools",       "yaml"};
const std::set<std::string> modules_with_fcl{"compare", "environment"};

const std::string header_of_ros =
    R"(^\s*#\s*include\s*[<"]((ros|roslib|tf2?|tf2_ros|xmlrpcpp|urdf|nodelet|pluginlib|octomap|)"
    R"([a-z_]+_msgs|std_srvs|geometric_shapes|interactive_markers|dynamic_reconfigure|)"
    R"(diagnostic_updater|fiber_proximity/ros)(/|\.h)|fiber_proximity/[^">]*\.h[">]))";
const std::string header_of_fcl = R"(|^\s*#\s*include\s*[<"](fcl|ccd)(/|\.h))";

/// @returns how many files there are
int expect_none(const std::filesystem::path& folder, const std::regex& forbidden) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    std::ifstream file(entry.path());
    files += entry.is_regular_file() ? 1 : 0;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      EXPECT_FALSE(std::regex_search(line, forbidden))
          << entry.path() << ":" << number << ": " << line;
    }
  }
  return files;
}

TEST(Core, IncludesNeitherRosNorFcl) {
  const std::filesystem::path source = fiber::test::source_folder();
  const std::regex ros(header_of_ros);
  const std::regex ros_and_fcl(header_of_ros + header_of_fcl);
  for (const std::string& module : modules) {
    int files = 0;
    for (const char* folder : {"include/fiber_proximity", "src"}) {
      const std::filesystem::path path = source / folder / module;
      if (std::filesystem::exists(path)) {
        files += expect_none(path, modules_with_fcl.count(module) > 0 ? ros : ros_and_fcl);
      }
    }
    EXPECT_GT(files, 1) << "there is no such module: " << module;
  }
}

TEST(Core, ScenesIncludeNeither) {
  const std::filesystem::path source = fiber::test::source_folder();
  const std::regex forbidden(header_of_ros + header_of_fcl);
  for (const char* folder : {"environment/scene", "sim/scene"}) {
    EXPECT_GT(expect_none(source / "src" / folder, forbidden), 1);
    EXPECT_GT(expect_none(source / "include/fiber_proximity" / folder, forbidden), 1);
  }
}

TEST(Core, WhatIsForbiddenIsSeen) {
  const std::regex forbidden(header_of_ros + header_of_fcl);
  for (const char* line : {"#include <ros/ros.h>", "#include <shape_msgs/Mesh.h>",
                           "# include \"fiber_proximity/Obstacle.h\"",
                           "#include \"fiber_proximity/ros/input.hpp\"", "#include <fcl/fcl.h>",
                           "#include <xmlrpcpp/XmlRpcValue.h>", "#include <tf2_ros/buffer.h>"}) {
    EXPECT_TRUE(std::regex_search(line, forbidden)) << line;
  }
  for (const char* line : {"#include <yaml-cpp/yaml.h>", "#include <assimp/scene.h>",
                           "#include \"fiber_proximity/sim/scene/scene.hpp\""}) {
    EXPECT_FALSE(std::regex_search(line, forbidden)) << line;
  }
}

}  // namespace
