#include "src/mpi/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace fiber {
namespace {

constexpr std::uint32_t boxes_per_leaf = 4;
constexpr double infinity = std::numeric_limits<double>::infinity();

SegmentBox joined(const SegmentBox& a, const SegmentBox& b) {
  return {merged(a.box, b.box), std::min(a.first, b.first)};
}

double centre(const SegmentBox& box, std::size_t axis) {
  return 0.5 * box.box.lower[axis] + 0.5 * box.box.upper[axis];
}

}  // namespace

PlainBox inflated(const PlainBox& box, double radius) {
  PlainBox larger;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    larger.lower[axis] = std::nextafter(box.lower[axis] - radius, -infinity);
    larger.upper[axis] = std::nextafter(box.upper[axis] + radius, infinity);
  }
  return larger;
}

PlainBox box_around(const FiberNode& start, const FiberNode& end) {
  return inflated(merged({start.point, start.point}, {end.point, end.point}), start.radius);
}

PlainBox merged(const PlainBox& a, const PlainBox& b) {
  PlainBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
    box.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
  }
  return box;
}

bool may_come_within(const PlainBox& a, const PlainBox& b, double margin) {
  double apart = -infinity;
  double extent = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    apart = std::max({apart, b.lower[axis] - a.upper[axis], a.lower[axis] - b.upper[axis]});
    extent = std::max({extent, b.upper[axis] - a.lower[axis], a.upper[axis] - b.lower[axis]});
  }
  // Four times what NarrowPhase::gap_lower_bound() allows for. Larger boxes allow for more, so what
  // is near a box is near all that are around it.
  return apart <= margin + 0x1p-46 * extent;
}

BoxTree::BoxTree(std::vector<SegmentBox> boxes)
    : boxes_(std::move(boxes)), numbers_(boxes_.size()) {
  if (boxes_.empty()) {
    return;
  }
  std::iota(numbers_.begin(), numbers_.end(), 0U);
  nodes_.reserve(boxes_.size() / boxes_per_leaf * 2 + 1);
  nodes_.push_back({{}, 0, static_cast<std::uint32_t>(boxes_.size()), 0});
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    split(node);
  }
}

SegmentBox BoxTree::around(const Node& node) const {
  if (node.left != 0) {
    return joined(nodes_[node.left].around, nodes_[node.left + 1].around);
  }
  SegmentBox all = boxes_[numbers_[node.begin]];
  for (std::uint32_t i = node.begin + 1; i < node.end; ++i) {
    all = joined(all, boxes_[numbers_[i]]);
  }
  return all;
}

/// Halves a node at the median of its longest axis.
void BoxTree::split(std::uint32_t node) {
  const std::uint32_t begin = nodes_[node].begin;
  const std::uint32_t end = nodes_[node].end;
  const SegmentBox all = around(nodes_[node]);
  nodes_[node].around = all;
  if (end - begin <= boxes_per_leaf) {
    return;
  }
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (all.box.upper[axis] - all.box.lower[axis] >
        all.box.upper[longest] - all.box.lower[longest]) {
      longest = axis;
    }
  }
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(numbers_.begin() + begin, numbers_.begin() + middle, numbers_.begin() + end,
                   [&](std::uint32_t x, std::uint32_t y) {
                     return centre(boxes_[x], longest) < centre(boxes_[y], longest);
                   });
  nodes_[node].left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, begin, middle, 0});
  nodes_.push_back({{}, middle, end, 0});
}

std::vector<SegmentBox> BoxTree::level_of_at_most(std::size_t count) const {
  std::vector<std::uint32_t> level;
  if (!empty()) {
    level.push_back(0);
  }
  for (bool goes_down = !empty(); goes_down;) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t node : level) {
      const std::uint32_t left = nodes_[node].left;
      next.push_back(left == 0 ? node : left);
      if (left != 0) {
        next.push_back(left + 1);
      }
    }
    goes_down = next.size() > level.size() && next.size() <= count;
    if (goes_down) {
      level = std::move(next);
    }
  }
  std::vector<SegmentBox> boxes;
  boxes.reserve(level.size());
  for (const std::uint32_t node : level) {
    boxes.push_back(nodes_[node].around);
  }
  return boxes;
}

bool BoxTree::has_near(const PlainBox& box, double margin, const GlobalSegment& last) const {
  const auto is_near = [&](const SegmentBox& other) {
    return other.first < last && may_come_within(other.box, box, margin);
  };
  if (empty()) {
    return false;
  }
  // Nodes halve: a tree of 2³² boxes has less levels, and of each level one node waits.
  std::array<std::uint32_t, 64> waiting{};
  std::size_t count = 1;
  while (count > 0) {
    const Node& node = nodes_[waiting[--count]];
    if (!is_near(node.around)) {
      continue;
    }
    if (node.left != 0) {
      waiting[count++] = node.left;
      waiting[count++] = node.left + 1;
    } else if (std::any_of(numbers_.begin() + node.begin, numbers_.begin() + node.end,
                           [&](std::uint32_t number) { return is_near(boxes_[number]); })) {
      return true;
    }
  }
  return false;
}

}  // namespace fiber
