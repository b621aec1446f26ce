#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// An axis-aligned box [m].
using Box3d = Eigen::AlignedBox3d;

/// It owns nothing, though Eigen writes its destructor out.
template <>
inline constexpr bool is_sendable<Box3d> = true;

/// Larger on all sides by a length [m], and by the roundings of distances to what is in it: four
/// times what NarrowPhase::gap_lower_bound() allows for.
inline Box3d inflated(const Box3d& box, double length) {
  double by = length;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    by = std::max(by, length + 0x1p-46 * (box.max()[axis] - box.min()[axis] + length));
  }
  Box3d larger;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    larger.min()[axis] = box.min()[axis] - (by + 0x1p-51 * std::abs(box.min()[axis]));
    larger.max()[axis] = box.max()[axis] + (by + 0x1p-51 * std::abs(box.max()[axis]));
  }
  return larger;
}

/// Whether capsules in the two boxes may be, or be found, as near as the margin [m].
inline bool may_come_within(const Box3d& a, const Box3d& b, double margin) {
  return inflated(a, margin).intersects(b);
}

/// The box around all of these; empty without any.
inline Box3d union_of(const std::vector<Box3d>& boxes) {
  Box3d all;
  for (const Box3d& box : boxes) {
    all.extend(box);
  }
  return all;
}

/// How many boxes, or nodes, a node of a BoxTree is around.
constexpr std::size_t fan = 4;

/// An order of these boxes in which those that follow each other are near each other, as a BoxTree
/// needs them.
/// @return their numbers
std::vector<std::uint32_t> spatial_order(const std::vector<Box3d>& boxes);

/// Boxes around boxes: each around four that follow each other. Finds out who is near. Boxes
/// are kept in single precision, little larger than they are.
class BoxTree {
 public:
  /// A box as a tree has it: seen from its origin [m].
  struct Box {
    std::array<float, 3> lower{};
    std::array<float, 3> upper{};

    Box merged(const Box& other) const {
      Box box;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(lower[axis], other.lower[axis]);
        box.upper[axis] = std::max(upper[axis], other.upper[axis]);
      }
      return box;
    }
    bool intersects(const Box& other) const {
      unsigned intersect = 1U;
      for (std::size_t axis = 0; axis < 3; ++axis) {  // without branches, which cannot be predicted
        intersect &= static_cast<unsigned>(lower[axis] <= other.upper[axis]) &
                     static_cast<unsigned>(other.lower[axis] <= upper[axis]);
      }
      return intersect != 0U;
    }
  };

  BoxTree() = default;

  /// Makes places for so many boxes. All must be put there, in an order like that of
  /// spatial_order().
  /// @param around most of them: the nearer they are to it, the less larger they get
  BoxTree(std::size_t count, const Box3d& around);

  /// Makes a tree of these boxes, which are in such an order.
  explicit BoxTree(const std::vector<Box3d>& boxes);

  bool empty() const { return boxes_.empty(); }
  Box3d box(std::uint32_t place) const { return absolute(boxes_[place]); }

  /// The box around all boxes; there must be any.
  Box3d root() const { return absolute(node(height(), 0)); }

  /// Boxes around the boxes of the lowest level that has at most so many.
  std::vector<Box3d> level_of_at_most(std::size_t count) const;

  /// A box in which this one is, to hold against those of the tree.
  Box seen_from_origin(const Box3d& box) const;
  bool meets(std::uint32_t place, const Box& box) const { return boxes_[place].intersects(box); }

  /// Puts a box at its place, or moves it. What is around it follows with close().
  void put(std::uint32_t place, const Box3d& box) { boxes_[place] = seen_from_origin(box); }
  void close();

  /// Calls with the place of each box that may come within the margin [m] of some of others, and
  /// with the places of those: call(place, first, last), pointers. Both trees are gone down
  /// together.
  template <class Call>
  void for_each_near(const BoxTree& others, double margin, const Call& call) const;

 private:
  /// A node to look at, and which nodes of others may be near it: part of a list.
  struct Visit {
    std::size_t level = 0;
    std::size_t index = 0;
    std::size_t level_of_others = 0;
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  /// Level 0 are the boxes themselves.
  std::size_t height() const { return begins_.size(); }
  std::size_t count_at(std::size_t level) const {
    if (level == 0) {
      return boxes_.size();
    }
    return (level < height() ? begins_[level] : nodes_.size()) - begins_[level - 1];
  }
  const Box& node(std::size_t level, std::size_t index) const {
    return level == 0 ? boxes_[index] : nodes_[begins_[level - 1] + index];
  }
  Box3d absolute(const Box& box) const;
  void append_meeting(const Box& box, const Visit& visit, std::vector<std::uint32_t>& places) const;
  void append_children(const Box& box, std::size_t level, std::size_t begin,
                       std::vector<std::uint32_t>& places) const;

  Eigen::Vector3d origin_{};
  std::vector<Box> boxes_;
  std::vector<Box> nodes_;           // level by level, from 1
  std::vector<std::size_t> begins_;  // of the levels
};

template <class Call>
void BoxTree::for_each_near(const BoxTree& others, double margin, const Call& call) const {
  if (empty() || others.empty()) {
    return;
  }
  std::vector<Visit> waiting{{height(), 0, others.height(), 0, 1}};
  std::vector<std::uint32_t> places{0};  // of others' nodes, list by list
  while (!waiting.empty()) {
    const Visit visit = waiting.back();
    waiting.pop_back();
    places.resize(visit.end);  // without the lists of visits that are over
    const Box box =
        others.seen_from_origin(inflated(absolute(node(visit.level, visit.index)), margin));
    others.append_meeting(box, visit, places);
    std::size_t begin = visit.end;
    std::size_t level_of_others = visit.level_of_others;
    while (level_of_others > visit.level && begin < places.size()) {
      const std::size_t end = places.size();
      others.append_children(box, level_of_others--, begin, places);
      begin = end;
    }
    if (begin == places.size()) {
      continue;
    }
    if (visit.level == 0) {
      call(static_cast<std::uint32_t>(visit.index), places.data() + begin,
           places.data() + places.size());
      continue;
    }
    const std::size_t first = fan * visit.index;
    for (std::size_t i = std::min(first + fan, count_at(visit.level - 1)); i-- > first;) {
      waiting.push_back({visit.level - 1, i, level_of_others, begin, places.size()});
    }
  }
}

}  // namespace fiber
