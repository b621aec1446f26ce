#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/continuous/known_motions.hpp"
#include "test/support/shared_data.hpp"

namespace fiber::test {

/// The file of public edge motions, which need not be there.
inline std::string public_edge_motions_path() {
  return (shared_data() / "edge_motions_public.csv").string();
}

/// Empty if the file is not there.
inline std::vector<bench::KnownMotion> public_edge_motions() {
  const std::string path = public_edge_motions_path();
  return std::filesystem::exists(path) ? bench::read_known_motions(path)
                                       : std::vector<bench::KnownMotion>();
}

}  // namespace fiber::test
