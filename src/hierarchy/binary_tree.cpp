#include "fiber_proximity/hierarchy/binary_tree.hpp"

namespace fiber {

BinaryTree BinaryTree::balanced(const std::vector<std::uint32_t>& order) {
  struct Run {
    std::uint32_t begin;
    std::uint32_t end;
  };
  BinaryTree tree;
  if (order.empty()) {
    return tree;
  }
  tree.nodes_.reserve(2 * order.size() - 1);
  std::vector<Run> level{{0, static_cast<std::uint32_t>(order.size())}};
  std::vector<Run> next;
  while (!level.empty()) {
    const auto level_begin = static_cast<std::uint32_t>(tree.nodes_.size());
    const auto next_begin = level_begin + static_cast<std::uint32_t>(level.size());
    tree.levels_.push_back(level_begin);
    next.clear();
    for (const Run& run : level) {
      if (run.end - run.begin == 1) {
        tree.nodes_.push_back(leaf_flag | order[run.begin]);
        continue;
      }
      tree.nodes_.push_back(next_begin + static_cast<std::uint32_t>(next.size()));
      const std::uint32_t middle = run.begin + (run.end - run.begin + 1) / 2;
      next.push_back({run.begin, middle});
      next.push_back({middle, run.end});
    }
    level.swap(next);
  }
  return tree;
}

}  // namespace fiber
