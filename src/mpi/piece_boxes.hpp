#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "src/mpi/box_tree.hpp"
#include "src/mpi/fiber_states.hpp"
#include "src/mpi/named_fibers.hpp"

namespace fiber {

/// Boxes around a few segments each that follow each other, and a tree of them.
class PieceBoxes {
 public:
  /// Takes fibres, or the same ones, moved, whose tree keeps its order.
  void update(const FiberStates& fibers, bool are_same);

  const BoxTree& tree() const { return tree_; }

  /// Calls with the segments that may come within the margin [m] of others that are before them, by
  /// the others' boxes: call(run, begin, end), along the run.
  template <class Call>
  void for_each_near(const FiberStates& fibers, const BoxTree& others, double margin,
                     const Call& call) const;

 private:
  struct Piece {
    std::uint32_t run = 0;
    std::uint32_t begin = 0;  // along the run
  };

  static constexpr std::uint64_t segments_per_piece = 8;

  static std::uint64_t end_of(const Piece& piece, const FiberRun& run) {
    return std::min(piece.begin + segments_per_piece, run.count);
  }
  static PlainBox box_of(const FiberStates& fibers, const Piece& piece);

  std::vector<Piece> pieces_;           // run by run
  std::vector<std::uint32_t> places_;   // of theirs in the tree
  std::vector<std::uint32_t> numbers_;  // of the pieces, in the tree's order
  BoxTree tree_{{}};
};

template <class Call>
void PieceBoxes::for_each_near(const FiberStates& fibers, const BoxTree& others, double margin,
                               const Call& call) const {
  std::vector<SegmentBox> near;
  const auto is_near = [&](const PlainBox& box, const GlobalSegment& segment) {
    return std::any_of(near.begin(), near.end(), [&](const SegmentBox& other) {
      return meet(other.box, box) && other.first < segment;
    });
  };
  tree_.for_each_near(
      others, margin, [&](std::uint32_t place, const auto* first, const auto* last) {
        const Piece& piece = pieces_[numbers_[place]];
        const FiberRun& run = fibers.before.runs()[piece.run];
        const std::uint64_t end = end_of(piece, run);
        near.clear();
        for (const auto* other = first; other != last; ++other) {
          const SegmentBox& box = others.box(*other);
          if (box.first < GlobalSegment{run.first.fiber, run.first.segment + end - 1}) {
            near.push_back(box);
          }
        }
        std::uint64_t begin = piece.begin;
        for (std::uint64_t i = begin; i <= end; ++i) {
          if (i < end &&
              is_near(inflated(fibers.box_around(run.begin + i, run.begin + i + 1), margin),
                      {run.first.fiber, run.first.segment + i})) {
            continue;
          }
          if (begin < i) {
            call(run, begin, i);
          }
          begin = i + 1;
        }
      });
}

}  // namespace fiber
