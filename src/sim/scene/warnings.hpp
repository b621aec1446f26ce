#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// What is not as the scene wants it after a frame.
struct SimWarning {
  enum class Kind {
    STRAIN,  ///< an edge is stretched by more than `max_strain`
    LAG,     ///< a hold pulls with its greatest force and is not followed
    BALANCE  ///< forces do not balance to `residual`; not of scenes that ask for few iterations
  };
  static constexpr std::size_t kinds = 3;

  Kind kind;
  std::string text;  ///< names fibre and place, how far it is, and what is allowed
};

/// At most one of each kind: the worst.
std::vector<SimWarning> frame_warnings(const SimScene& scene);

}  // namespace fiber
