#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "fiber_proximity/scenes/hard_motions.hpp"
#include "support/shared_data.hpp"

namespace fiber::test {

/// Two edges that move, and whether they collide.
struct EdgeMotion {
  HardMotion motion;
  bool collides = false;
};

/// The file of public edge motions, which need not be there.
inline std::string public_edge_motions_path() {
  return (shared_data() / "edge_motions_public.csv").string();
}

/// Empty if the file is not there.
inline std::vector<EdgeMotion> public_edge_motions() {
  std::vector<EdgeMotion> motions;
  std::ifstream file(public_edge_motions_path());
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    std::getline(fields, field, ',');
    EdgeMotion edges;
    edges.collides = field == "1";
    for (Eigen::Vector3d* ends : {edges.motion.a_before, edges.motion.b_before,
                                  edges.motion.a_after, edges.motion.b_after}) {
      for (int i = 0; i < 2; ++i) {
        for (double& coordinate : ends[i]) {
          EXPECT_TRUE(std::getline(fields, field, ',')) << line;
          coordinate = std::strtod(field.c_str(), nullptr);
        }
      }
    }
    motions.push_back(edges);
  }
  return motions;
}

}  // namespace fiber::test
