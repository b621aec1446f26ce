#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// An axis-aligned box that travels [m].
struct PlainBox {
  PlainPoint lower{};
  PlainPoint upper{};
};

/// That encloses capsules of up to this radius [m] around what is in the box, roundings included.
PlainBox inflated(const PlainBox& box, double radius);

/// That encloses the capsule.
PlainBox box_around(const FiberNode& start, const FiberNode& end);

PlainBox merged(const PlainBox& a, const PlainBox& b);

/// Whether capsules in the two boxes may be as near as the margin [m], or be found so near: the
/// roundings of their distance are allowed for.
bool may_come_within(const PlainBox& a, const PlainBox& b, double margin);

/// A box around some segments, and the first of them in the order of contacts.
struct SegmentBox {
  PlainBox box;
  GlobalSegment first;
};

/// Boxes around boxes: finds whether any of many is near.
class BoxTree {
 public:
  explicit BoxTree(std::vector<SegmentBox> boxes);

  bool empty() const { return boxes_.empty(); }

  /// Around all; there must be any.
  const SegmentBox& root() const { return nodes_.front().around; }

  /// Boxes around the nodes of the lowest level that has at most so many, and around leaves above.
  std::vector<SegmentBox> level_of_at_most(std::size_t count) const;

  /// Moves the boxes: of each segments of before the new one, as box_of(number) gives it.
  template <class BoxOf>
  void refit(const BoxOf& box_of);

  /// Calls with the boxes that may come within the margin [m] of one of others, and with their
  /// numbers: call(box, number).
  template <class Call>
  void for_each_near(const BoxTree& others, double margin, const Call& call) const;

  /// Whether there is a box that may come within the margin of this one [m], of segments of which
  /// one is before `last`.
  bool has_near(const PlainBox& box, double margin, const GlobalSegment& last) const;

 private:
  struct Node {
    SegmentBox around;
    std::uint32_t begin = 0;  // of its boxes' numbers
    std::uint32_t end = 0;
    std::uint32_t left = 0;  // child, the other one follows it; 0 for a leaf
  };

  void split(std::uint32_t node);

  // After everything.
  static constexpr GlobalSegment no_limit{~std::uint64_t{0}, ~std::uint64_t{0}};

  SegmentBox around(const Node& node) const;

  std::vector<SegmentBox> boxes_;       // as they were given
  std::vector<std::uint32_t> numbers_;  // of theirs, leaf by leaf
  std::vector<Node> nodes_;
};

template <class BoxOf>
void BoxTree::refit(const BoxOf& box_of) {
  for (std::uint32_t number = 0; number < boxes_.size(); ++number) {
    boxes_[number].box = box_of(number);
  }
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    node->around = around(*node);  // children come after their parents
  }
}

template <class Call>
void BoxTree::for_each_near(const BoxTree& others, double margin, const Call& call) const {
  const auto is_near = [&](const SegmentBox& around) {
    return others.has_near(around.box, margin, no_limit);
  };
  std::vector<std::uint32_t> waiting(empty() ? 0 : 1, 0);
  while (!waiting.empty()) {
    const Node& node = nodes_[waiting.back()];
    waiting.pop_back();
    if (!is_near(node.around)) {
      continue;
    }
    if (node.left != 0) {
      waiting.push_back(node.left);
      waiting.push_back(node.left + 1);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const std::uint32_t number = numbers_[i];
      if (is_near(boxes_[number])) {
        call(boxes_[number], number);
      }
    }
  }
}

}  // namespace fiber
