#pragma once

#include <stdexcept>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/text/quote.hpp"

namespace fiber::test {

/// A source that has no meshes: what the fuzzer writes is not to be looked for on this machine.
inline std::shared_ptr<const TriangleMesh> no_mesh(const std::string& resource,
                                                   const Eigen::Vector3d& /*scale*/) {
  throw std::invalid_argument("mesh " + quote(resource) + ": there are none here");
}

}  // namespace fiber::test
