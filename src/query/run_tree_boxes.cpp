#include "src/query/run_tree_boxes.hpp"

#include <algorithm>

namespace fiber {
namespace {

Eigen::Vector3d corner(const float (&by_axis)[3][run_width], std::uint32_t lane) {
  return {by_axis[0][lane], by_axis[1][lane], by_axis[2][lane]};
}

NodeBox child_box(const RunTree& tree, const RunTreeLevel& level, std::uint32_t child) {
  const BoxBlock& block = level.boxes[child / run_width];
  return {tree.origin() + corner(block.lower, child % run_width),
          tree.origin() + corner(block.upper, child % run_width)};
}

}  // namespace

NodeBox run_tree_box(const RunTree& tree) {
  const RunTreeView& view = tree.view();
  if (view.level_count == 0) {
    return {tree.origin(), tree.origin()};
  }
  const RunTreeLevel& top = view.levels[view.level_count - 1];
  NodeBox box = child_box(tree, top, 0);
  for (std::uint32_t child = 1; child < top.child_count; ++child) {
    const NodeBox other = child_box(tree, top, child);
    box = {box.lower.cwiseMin(other.lower), box.upper.cwiseMax(other.upper)};
  }
  return box;
}

void run_tree_boxes(const RunTree& tree, const MotionSinceFit& since, std::uint32_t level,
                    std::vector<NodeBox>& boxes) {
  boxes.clear();
  const RunTreeView& view = tree.view();
  if (view.level_count == 0) {
    return;
  }
  const auto add = [&](const NodeBox& box) {
    boxes.push_back({box.lower + since.drift - Eigen::Vector3d::Constant(since.beyond),
                     box.upper + since.drift + Eigen::Vector3d::Constant(since.beyond)});
  };
  if (level == 0) {  // which the tree has no box for
    add(run_tree_box(tree));
    return;
  }
  const RunTreeLevel& shown = view.levels[view.level_count - std::min(level, view.level_count)];
  for (std::uint32_t child = 0; child < shown.child_count; ++child) {
    add(child_box(tree, shown, child));
  }
}

}  // namespace fiber
