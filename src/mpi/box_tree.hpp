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

/// That encloses the capsule, roundings included.
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
  const std::vector<SegmentBox>& boxes() const { return boxes_; }

  /// Around all; there must be any.
  const SegmentBox& root() const { return nodes_.front().around; }

  /// Boxes around the nodes of the lowest level that has at most so many, and around leaves above.
  std::vector<SegmentBox> level_of_at_most(std::size_t count) const;

  /// Whether there is a box that may come within the margin of this one [m], of segments of which
  /// one is before `last`.
  bool has_near(const PlainBox& box, double margin, const GlobalSegment& last) const;

 private:
  struct Node {
    SegmentBox around;
    std::uint32_t begin = 0;  // of its boxes
    std::uint32_t end = 0;
    std::uint32_t left = 0;  // child, the other one follows it; 0 for a leaf
  };

  void split(std::uint32_t node);

  std::vector<SegmentBox> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace fiber
