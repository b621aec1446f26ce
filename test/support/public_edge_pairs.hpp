#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "test/support/shared_data.hpp"

namespace fiber::test {

/// A pair of segments and its exact distance, rounded to the nearest double [m].
struct EdgePair {
  Eigen::Vector3d p0, p1, q0, q1;
  double distance = 0.0;
};

/// The file of public edge pairs, which need not be there.
inline std::string public_edge_pairs_path() {
  return (shared_data() / "edge_pairs_public.csv").string();
}

/// Empty if the file is not there.
inline std::vector<EdgePair> public_edge_pairs() {
  std::vector<EdgePair> pairs;
  std::ifstream file(public_edge_pairs_path());
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    double values[13];
    for (double& value : values) {
      EXPECT_TRUE(std::getline(fields, field, ',')) << line;
      value = std::strtod(field.c_str(), nullptr);
    }
    pairs.push_back({Eigen::Vector3d(values), Eigen::Vector3d(values + 3),
                     Eigen::Vector3d(values + 6), Eigen::Vector3d(values + 9), values[12]});
  }
  return pairs;
}

}  // namespace fiber::test
