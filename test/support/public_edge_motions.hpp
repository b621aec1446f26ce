#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "test/support/shared_data.hpp"
#include "validation/geometry/known_motions.hpp"

namespace fiber::test {

/// The file of public edge motions, which need not be there.
inline std::string public_edge_motions_path() {
  return (shared_data() / "edge_motions_public.csv").string();
}

/// Empty if the file is not there.
inline std::vector<KnownMotion> public_edge_motions() {
  const std::string path = public_edge_motions_path();
  return std::filesystem::exists(path) ? read_known_motions(path) : std::vector<KnownMotion>();
}

}  // namespace fiber::test
