// docs/scene_keys.md tells which keys scenes have, and the reader knows these and no others.
#include "src/sim/scene/keys.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "test/sim/scene/scene_fixture.hpp"
#include "test/support/source_folder.hpp"

namespace fiber {
namespace {

constexpr const char* no_error = "no error";  // of error_of()
constexpr const char* write_variable = "FIBER_PROXIMITY_WRITE_REFERENCE";

std::string page() {
  std::ostringstream text;
  text << "# The keys of scenes\n\n"
          "All keys of the scenes of `cable_sim` and `fiber_simulate`; "
          "[simulation.md](simulation.md) is the\n"
          "guide. A number must be finite. Made from `keys.cpp` and `effect_keys.cpp` in "
          "`src/sim/scene` by\n`"
       << write_variable << "=1 sim_scene_test --gtest_filter='SceneKeys*'`.\n";
  for (const SceneMap& map : scene_maps()) {
    const bool is_shape = map.name.rfind("shape ", 0) == 0;
    const std::string name = is_shape ? map.name.substr(6) : map.name;
    text << "\n## "
         << (map.is_effect ? "Effect "
             : is_shape    ? "Shape "
                           : "")
         << "`" << name << "`\n";
    text << (map.about.empty() ? "" : "\n") << map.about << (map.about.empty() ? "" : "\n");
    text << (map.keys.empty() ? "" : "\n| key | default | unit | must be | |\n|-|-|-|-|-|\n");
    for (const SceneKey& key : map.keys) {
      text << "| `" << key.name << "` |";
      for (const std::string& cell : {key.by_default, key.unit, key.allowed, key.text}) {
        text << (cell.empty() ? "" : " ") << cell << " |";
      }
      text << "\n";
    }
  }
  return text.str();
}

TEST(SceneKeysPage, ThePageTellsThem) {
  const auto file = test::source_folder() / "docs/scene_keys.md";
  if (std::getenv(write_variable) != nullptr) {
    std::ofstream(file) << page();
  }
  std::stringstream written;
  written << std::ifstream(file).rdbuf();
  EXPECT_EQ(written.str(), page())
      << "make it again: " << write_variable << "=1 sim_scene_test --gtest_filter='SceneKeys*'";
}

/// A scene with this value of a key.
std::string scene_with(const SceneMap& map, const std::string& key, const std::string& value) {
  const std::size_t dot = key.find('.');
  const std::string option =
      dot == std::string::npos
          ? key + ": " + value
          : key.substr(0, dot) + ": {" + key.substr(dot + 1) + ": " + value + "}";
  const auto with = [&](const std::string& others) {
    return "{" + others + (others.empty() ? "" : ", ") + option + "}";
  };
  // Keys of which there must be some, without the one that is looked at.
  const auto others = [&key](const std::vector<std::pair<std::string, std::string>>& all) {
    std::string text;
    for (const auto& [name, given] : all) {
      text += name == key ? "" : (text.empty() ? "" : ", ") + name + ": " + given;
    }
    return text;
  };
  const std::string joined_nodes = "[{fiber: a}, {fiber: thick}]";
  // All that is within its radius may be joined with it.
  const std::string thick = map.name.rfind("joint", 0) == 0
                                ? ", {name: thick, shape: {line: {from: [0, 1, 0], to: [0, 3, "
                                  "0]}}, segments: 2, radius: 2,"
                                  " material: rope}"
                                : "";
  std::string shape = line;
  std::string repeat;
  std::string material = "rope";
  std::string effects = "gravity, stretch, twist";
  std::string environment;
  if (map.name == "scene") {
    const std::string scene = others(
        {{"fibers", "[{name: a, shape: " + shape + ", segments: 2, radius: 0.01, material: rope}]"},
         {"effects", "[stretch]"}});
    return with(scene) + "\n";
  }
  if (map.name == "fiber") {
    return "{effects: [stretch], fibers: [" +
           with(others({{"name", "a"},
                        {"shape", shape},
                        {"segments", "2"},
                        {"radius", "0.01"},
                        {"material", "rope"}})) +
           "]}\n";
  }
  if (map.name == "section") {
    repeat = ", sections: [" + with(others({{"material", "rope"}})) + "]";
  } else if (map.name == "repeat") {
    repeat = ", repeat: " + with(others({{"count", "2"}, {"offset", "[0, 1, 0]"}}));
  } else if (map.name == "material") {
    material = with("");
  } else if (map.name == "shape line" || map.name == "shape arc") {
    const std::string arc = map.name == "shape arc" ? "arc" : "line";
    std::vector<std::pair<std::string, std::string>> all{{"from", "[0, 0, 0]"},
                                                         {"to", "[1, 0, 0]"}};
    if (arc == "arc") {
      all.emplace_back("length", "2");
    }
    shape = "{" + arc + ": " + with(others(all)) + "}";
  } else if (map.name == "shape helix") {
    shape =
        "{helix: " +
        with(others({{"center", "[0, 0, 0]"}, {"radius", "1"}, {"pitch", "1"}, {"turns", "2"}})) +
        "}";
  } else if (map.name == "shape trefoil") {
    shape = "{trefoil: " + with(others({{"center", "[0, 0, 0]"}, {"size", "1"}})) + "}";
  } else if (map.name == "attachment") {
    const std::string path = key == "period" ? ", path: [{time: 0}, {time: 1}]" : "";
    effects += ", {attachment: [" + with(others({{"fiber", "a"}}) + path) + "]}";
  } else if (map.name == "waypoint") {
    effects += ", {attachment: [{fiber: a, path: [" + with(others({{"time", "0"}})) + "]}]}";
  } else if (map.name == "joint") {
    effects += ", bend, {joint: [" + with(others({{"nodes", joined_nodes}})) + "]}";
  } else if (map.name == "joint node") {
    effects += ", {joint: [{nodes: [" + with(others({{"fiber", "a"}})) + ", {fiber: thick}]}]}";
  } else if (map.name == "load") {
    std::vector<std::pair<std::string, std::string>> all{{"fiber", "a"}, {"mass", "1"}};
    if (key != "from" && key != "to") {
      all.emplace_back("node", "last");
    }
    if (key == "period") {
      all.emplace_back("table", "[{time: 0}, {time: 1}]");
    }
    effects += ", {load: [" + with(others(all)) + "]}";
  } else if (map.name == "table") {
    const std::string table = "table: [" + with(others({{"time", "0"}})) + "]";
    effects = key == "acceleration" ? "{gravity: {" + table + "}}"
                                    : "twist, {load: [{fiber: a, node: last, " + table + "}]}";
  } else if (map.name == "obstacle link") {
    environment = ", environment: {obstacles: [" + with(others({{"link", "hand"}})) + "]}";
  } else if (map.name.rfind("obstacle", 0) == 0) {
    const std::string waypoint =
        map.name == "obstacle waypoint" ? with(others({{"time", "0"}})) : "{time: 0}";
    const std::string path = "path: [" + waypoint + "]";
    environment =
        ", environment: {obstacles: [{id: ball, primitives: [{type: sphere, dimensions: [1]}], "
        "motion: " +
        (map.name == "obstacle waypoint"   ? "{" + path + "}"
         : key == "path" || key == "frame" ? with("")
                                           : with(path)) +
        "}]}";
  } else {
    EXPECT_TRUE(map.is_effect) << "this test knows no scene with " << map.name;
    effects = map.name == "gravity" ? "stretch" : effects;
    const bool is_gravity_period = map.name == "gravity" && key == "period";
    effects += ", {" + map.name + ": " +
               with(key == "towards"    ? "natural_curvature: 1"
                    : is_gravity_period ? "table: [{time: 0}]"
                                        : "") +
               "}";
    effects += map.name == "friction"     ? ", fiber_contact"
               : map.name == "plasticity" ? ", bend"
                                          : "";
    if (map.name == "environment_contact") {
      environment =
          ", environment: {obstacles: [{id: table, half_spaces: [{coef: [0, 0, 1, 9]}]}]}";
    }
  }
  return "{effects: [" + effects + "], fibers: [{name: a, shape: " + shape +
         ", segments: 2, radius: 0.01, material: " + material + repeat + "}" + thick + "]" +
         environment + "}\n";
}

class SceneKeys : public SimSceneTest {
 protected:
  std::string error_with(const SceneMap& map, const std::string& key, const std::string& value) {
    test_meshes::write(file_, scene_with(map, key, value));
    const LinkSource any_link = [](const auto& /*link*/, const auto& /*description*/) {
      return std::vector<PlacedShape>{{SphereShape{0.1}, Eigen::Isometry3d::Identity()}};
    };
    return error_of([&] {
      make_sim_scene(read_sim_scene(load_yaml(file_), mesh_files(folder_.path("")), {}, any_link),
                     1);
    });
  }
};

TEST_F(SceneKeys, AreReadAndNoOthers) {
  int keys = 0;
  for (const SceneMap& map : scene_maps()) {
    for (const SceneKey& key : map.keys) {
      SCOPED_TRACE(map.name + ", key " + key.name);
      const std::string error = error_with(map, key.name, "[{no: value}, of any]");
      EXPECT_NE(error, no_error);
      EXPECT_EQ(error.find("unknown key '" + key.name), std::string::npos) << error;
      ++keys;
    }
    if (!map.keys.empty()) {
      const std::string error = error_with(map, "nonsense", "1");
      EXPECT_NE(error.find("has the unknown key 'nonsense'"), std::string::npos) << error;
    }
  }
  EXPECT_GT(keys, 50);
}

std::string exact(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

TEST_F(SceneKeys, HaveTheirLimitsAndDefaults) {
  int limited = 0;
  for (const SceneMap& map : scene_maps()) {
    for (const SceneKey& key : map.keys) {
      SCOPED_TRACE(map.name + ", key " + key.name);
      if (key.by_default != "required" && key.by_default != "") {
        EXPECT_EQ(error_with(map, key.name, key.by_default), no_error);
      }
      if (!key.limits) {
        continue;
      }
      ++limited;
      const KeyLimits& limits = *key.limits;
      EXPECT_NE(error_with(map, key.name, exact(limits.min - 1.0)), no_error);
      EXPECT_EQ(error_with(map, key.name, exact(limits.min)) == no_error,
                limits.contain(limits.min));
      const bool is_unlimited = std::isinf(limits.max);
      if (is_unlimited || limits.excludes_max) {
        EXPECT_NE(error_with(map, key.name, is_unlimited ? ".inf" : exact(limits.max)), no_error);
      } else if (key.name != "segments" && key.name != "count") {  // so many would take long
        EXPECT_EQ(error_with(map, key.name, exact(limits.max)), no_error);
      }
      if (!is_unlimited) {
        EXPECT_NE(error_with(map, key.name, exact(limits.max + 1.0)), no_error);
      }
      EXPECT_NE(error_with(map, key.name, ".nan"), no_error);
    }
  }
  EXPECT_GT(limited, 25);
}

}  // namespace
}  // namespace fiber
