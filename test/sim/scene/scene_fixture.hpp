#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "test/support/error_of.hpp"
#include "test/support/mesh_files.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber {

using test::error_of;

/// A scene with this in place of its fibre's shape, and these effects.
inline std::string scene_text(const std::string& shape, const std::string& effects,
                              const std::string& more = "") {
  return "fibers:\n"
         "  - name: cable\n"
         "    shape: " +
         shape +
         "\n"
         "    segments: 4\n"
         "    radius: 0.01\n"
         "    material: rope\n"
         "effects: " +
         effects + "\n" + more;
}

inline const char* const line = "{line: {from: [0, 0, 0], to: [1, 0, 0]}}";

/// A scene whose fibre has no segments of its own.
inline std::string open_text(const std::string& shape, const std::string& more) {
  std::string text = scene_text(shape, "[gravity, stretch, bend]", more);
  text.replace(text.find("    segments: 4\n"), 16, "");
  return text;
}

class SimSceneTest : public ::testing::Test {
 protected:
  SimSceneTest() : file_(folder_.path("scene.yaml")) {}

  SimDescription describe(const std::string& text, const FrameTimer& timer = {}) {
    test_meshes::write(file_, text);
    return read_sim_scene(load_yaml(file_), mesh_files(folder_.path("")), timer);
  }

  SimScene read(const std::string& text) { return make_sim_scene(describe(text), 1); }

  /// The error without the file's name, which it begins with.
  std::string error(const std::string& text) {
    const std::string error = error_of([&] { read(text); });
    EXPECT_EQ(error.rfind(file_ + ":", 0), 0U) << error;
    return error.substr(std::min(error.size(), file_.size() + 1));
  }

  test::TemporaryDirectory folder_;
  std::string file_;
};

}  // namespace fiber
