#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "src/hierarchy/motion_since_fit.hpp"
#include "src/hierarchy/run_tree.hpp"

namespace fiber {

/// Around all segments where the tree has them; a point without any.
NodeBox run_tree_box(const RunTree& tree);

/// The boxes of a level, around where the segments are by now.
/// @param level from the root at 0 down; the lowest one for those below it
/// @param since of the segments, where the tree has them
void run_tree_boxes(const RunTree& tree, const MotionSinceFit& since, std::uint32_t level,
                    std::vector<NodeBox>& boxes);

}  // namespace fiber
