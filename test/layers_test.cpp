// Who may include whom: the order of CONTRIBUTING.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <string>
#include <vector>

#include "test/support/source_folder.hpp"

namespace {

namespace fs = std::filesystem;

/// Folders of src and include/fiber_proximity, each after those that it may include. What stands on
/// one line is beside each other: it may not include its neighbours.
const std::vector<std::vector<std::string>> layers{
    {"text"},
    {"geometry", "yaml"},
    {"bounds"},
    {"hierarchy"},
    {"query", "io"},
    {"paper", "cuda", "scenes", "environment", "compare", "mpi"},
    {"environment/scene", "sim", "accuracy"},
    {"sim/scene"},
    {"tools", "python", "ros"},
    {"ros/support"},
    {"ros/inputs"},
    {"ros/environment"},
    {"ros/detection"},
    {"ros/outputs"},
    {"ros/server", "ros/sim", "ros/bridges", "ros/player", "rviz"},
    {"nodes"},
};

/// Folders with all below them, but for those that are layers of their own.
bool is_in(const std::string& folder, const std::string& layer) {
  return folder == layer || folder.rfind(layer + "/", 0) == 0;
}

constexpr std::size_t none = 1000;

/// The layer of a file in one of these folders, the deepest folder that is in the list.
std::pair<std::size_t, std::string> layer_of(const std::string& folder) {
  std::pair<std::size_t, std::string> found{none, ""};
  for (std::size_t i = 0; i < layers.size(); ++i) {
    for (const std::string& layer : layers[i]) {
      if (is_in(folder, layer) && layer.size() > found.second.size()) {
        found = {i, layer};
      }
    }
  }
  return found;
}

bool may_include(const std::string& folder, const std::string& other) {
  const auto [layer, name] = layer_of(folder);
  const auto [other_layer, other_name] = layer_of(other);
  return other_layer < layer || (other_layer == layer && other_name == name);
}

/// The folder of an include that is ours, "" of others: generated messages among them.
std::string folder_of(const std::string& line) {
  static const std::regex ours(R"(^\s*#\s*include\s*"(?:src|fiber_proximity)/(.*)/[^/"]*\.hpp".*)");
  std::smatch match;
  return std::regex_match(line, match, ours) ? match[1].str() : "";
}

/// Calls with each line of the sources in this folder and below.
int for_each_line(const fs::path& folder,
                  const std::function<void(const fs::path&, int, const std::string&)>& call) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string kind = entry.path().extension();
    if (kind != ".cpp" && kind != ".hpp") {
      continue;
    }
    ++files;
    std::ifstream file(entry.path());
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      call(entry.path(), ++number, line);
    }
  }
  return files;
}

/// The two folders that a module stands in.
const std::vector<fs::path>& roots() {
  static const fs::path source = fiber::test::source_folder();
  static const std::vector<fs::path> all{source / "src", source / "include/fiber_proximity"};
  return all;
}

TEST(Layers, IncludesGoDown) {
  int files = 0;
  int includes = 0;
  for (const fs::path& root : roots()) {
    files += for_each_line(root, [&](const fs::path& path, int number, const std::string& line) {
      const std::string other = folder_of(line);
      if (!other.empty()) {
        ++includes;
        const std::string folder = fs::relative(path.parent_path(), root);
        EXPECT_TRUE(may_include(folder, other)) << path << ":" << number << ": " << line;
      }
    });
  }
  EXPECT_GT(files, 300);
  EXPECT_GT(includes, 2 * files);
}

TEST(Layers, EachHasSources) {
  for (const auto& beside : layers) {
    for (const std::string& layer : beside) {
      EXPECT_TRUE(std::any_of(roots().begin(), roots().end(), [&](const fs::path& root) {
        return fs::exists(root / layer);
      })) << layer;
    }
  }
}

TEST(Layers, AFolderWithoutOneMayNotInclude) {
  EXPECT_TRUE(may_include("query", "geometry"));
  EXPECT_TRUE(may_include("sim/solver", "sim/contact"));
  EXPECT_TRUE(may_include("sim/scene", "sim/effects"));
  EXPECT_FALSE(may_include("sim/effects", "sim/scene"));
  EXPECT_FALSE(may_include("hierarchy", "query"));
  EXPECT_FALSE(may_include("query", "io"));
  EXPECT_FALSE(may_include("query", "new_folder"));
  EXPECT_FALSE(may_include("tools", "ros/inputs"));
}

/// Calls with the source of each line in the repository that matches, and the first group of the
/// match.
void for_each_match(
    const std::regex& pattern,
    const std::function<void(const fs::path& path, const std::string& group)>& call) {
  for (const char* folder : {"src", "include", "test", "benchmark", "validation"}) {
    for_each_line(fs::path(fiber::test::source_folder()) / folder,
                  [&](const fs::path& path, int number, const std::string& line) {
                    std::smatch match;
                    if (std::regex_match(line, match, pattern)) {
                      SCOPED_TRACE(path.string() + ":" + std::to_string(number) + ": " + line);
                      call(path, match[1].str());
                    }
                  });
  }
}

TEST(Layers, IncludesHaveOneSpelling) {
  static const std::regex ours(R"x(^\s*#\s*include\s*"(.*\.(?:hpp|inc))".*)x");
  static const std::regex from_root(R"((src|test|benchmark|validation|fiber_proximity)/.*)");
  const fs::path source = fiber::test::source_folder();
  for_each_match(ours, [&](const fs::path& /*path*/, const std::string& included) {
    EXPECT_TRUE(std::regex_match(included, from_root));
    EXPECT_TRUE(fs::exists(source / included) || fs::exists(source / "include" / included));
  });
}

/// Whether a source in this folder of the repository may include one of `test`, `benchmark` or
/// `validation`.
bool may_include_checks(const std::string& folder, const std::string& other) {
  if (other == "validation") {
    return is_in(folder, "test") || is_in(folder, "benchmark") || is_in(folder, "validation");
  }
  return is_in(folder, other) || (other == "benchmark" && is_in(folder, "test/benchmark"));
}

TEST(Layers, TestsAndBenchmarksMeetInValidationOnly) {
  static const std::regex checks(R"(^\s*#\s*include\s*"(test|benchmark|validation)/.*)");
  const fs::path source = fiber::test::source_folder();
  for_each_match(checks, [&](const fs::path& path, const std::string& root) {
    EXPECT_TRUE(may_include_checks(fs::relative(path.parent_path(), source), root));
  });
}

TEST(Layers, ATestMayNotIncludeABenchmark) {
  EXPECT_TRUE(may_include_checks("test/sim", "validation"));
  EXPECT_TRUE(may_include_checks("test/benchmark", "benchmark"));
  EXPECT_FALSE(may_include_checks("test/sim", "benchmark"));
  EXPECT_FALSE(may_include_checks("benchmark/sim", "test"));
  EXPECT_FALSE(may_include_checks("validation/sim", "test"));
  EXPECT_FALSE(may_include_checks("src/tools", "benchmark"));
}

const std::string header_of_ros =
    R"(^\s*#\s*include\s*[<"]((ros|roslib|tf2?|tf2_ros|xmlrpcpp|urdf|nodelet|pluginlib|octomap|)"
    R"([a-z_]+_msgs|std_srvs|geometric_shapes|interactive_markers|dynamic_reconfigure|)"
    R"(diagnostic_updater)(/|\.h)|fiber_proximity/[^">]*\.h[">]))";
const std::string header_of_fcl = R"(|^\s*#\s*include\s*[<"](fcl|ccd)(/|\.h))";

/// Who may include headers of ROS, and of FCL: with what is below.
bool may_use_ros(const std::string& folder) {
  return is_in(folder, "ros") || is_in(folder, "rviz") || is_in(folder, "nodes");
}
bool may_use_fcl(const std::string& folder) {
  return may_use_ros(folder) || is_in(folder, "compare") ||
         (is_in(folder, "environment") && !is_in(folder, "environment/scene"));
}

TEST(Layers, TheCoreIncludesNeitherRosNorFcl) {
  const std::regex ros(header_of_ros);
  const std::regex ros_and_fcl(header_of_ros + header_of_fcl);
  for (const fs::path& root : roots()) {
    for_each_line(root, [&](const fs::path& path, int number, const std::string& line) {
      const std::string folder = fs::relative(path.parent_path(), root);
      if (!may_use_ros(folder)) {
        EXPECT_FALSE(std::regex_search(line, may_use_fcl(folder) ? ros : ros_and_fcl))
            << path << ":" << number << ": " << line;
      }
    });
  }
}

TEST(Layers, WhatIsForbiddenIsSeen) {
  const std::regex forbidden(header_of_ros + header_of_fcl);
  for (const char* line : {"#include <ros/ros.h>", "#include <shape_msgs/Mesh.h>",
                           "# include \"fiber_proximity/Obstacle.h\"", "#include <fcl/fcl.h>",
                           "#include <xmlrpcpp/XmlRpcValue.h>", "#include <tf2_ros/buffer.h>"}) {
    EXPECT_TRUE(std::regex_search(line, forbidden)) << line;
  }
  for (const char* line : {"#include <yaml-cpp/yaml.h>", "#include <assimp/scene.h>",
                           "#include \"fiber_proximity/sim/scene/scene.hpp\""}) {
    EXPECT_FALSE(std::regex_search(line, forbidden)) << line;
  }
}

}  // namespace
