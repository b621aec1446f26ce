#pragma once

#include <cstdint>
#include <vector>

#include "src/mpi/box_tree.hpp"
#include "src/mpi/named_fibers.hpp"

namespace fiber {

/// Boxes around a few segments each that follow each other, and a tree of them.
class PieceBoxes {
 public:
  /// Takes fibres, or the same ones, moved, whose tree keeps its order.
  void update(const NamedFibers& fibers, bool are_same);

  const BoxTree& tree() const { return tree_; }

  /// Calls with the segments that may come within the margin [m] of others that are before them, by
  /// the others' boxes: call(run, begin, end), along the run.
  template <class Call>
  void for_each_near(const NamedFibers& fibers, const BoxTree& others, double margin,
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

  std::vector<Piece> pieces_;
  BoxTree tree_{{}};
};

template <class Call>
void PieceBoxes::for_each_near(const NamedFibers& fibers, const BoxTree& others, double margin,
                               const Call& call) const {
  tree_.for_each_near(others, margin, [&](const SegmentBox& box, std::uint32_t number) {
    const Piece& piece = pieces_[number];
    const FiberRun& run = fibers.runs()[piece.run];
    const std::uint64_t end = end_of(piece, run);
    if (!others.has_near(box.box, margin, {run.first.fiber, run.first.segment + end - 1})) {
      return;
    }
    std::uint64_t begin = piece.begin;
    for (std::uint64_t i = begin; i <= end; ++i) {
      const bool is_near =
          i < end &&
          others.has_near(box_around(fibers.node(run.begin + i), fibers.node(run.begin + i + 1)),
                          margin, {run.first.fiber, run.first.segment + i});
      if (!is_near) {
        if (begin < i) {
          call(run, begin, i);
        }
        begin = i + 1;
      }
    }
  });
}

}  // namespace fiber
