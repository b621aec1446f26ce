#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include "src/mpi/box_tree.hpp"
#include "src/mpi/fiber_states.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/piece_capsule.hpp"

namespace fiber {

/// A few segments that follow each other, as others see them.
struct NearPiece {
  GlobalSegment first;
  PieceCapsule capsule;
};

/// Pieces of others: a tree of boxes around them, and the pieces by their places.
struct NearPieces {
  BoxTree tree;
  std::vector<NearPiece> pieces;
};

/// Boxes around a few segments each that follow each other, and a tree of them.
class PieceBoxes {
 public:
  /// Takes fibres, or the same ones, moved, whose tree keeps its order.
  void update(const FiberStates& fibers, bool are_same);

  const BoxTree& tree() const { return tree_; }

  /// [m] Of the boxes, of all three sides; infinity without any.
  double mean_side() const;

  /// The pieces at these places of the tree.
  std::vector<NearPiece> pieces(const FiberStates& fibers,
                                const std::vector<std::uint32_t>& places) const;

  /// All pieces, in the tree's order.
  NearPieces all(const FiberStates& fibers) const;

  /// Calls with the segments that may come within the margin [m] of others that are before them, by
  /// what is around these: call(number of the run, begin, end), along the run.
  template <class Call>
  void for_each_near(const FiberStates& fibers, const NearPieces& others, double margin,
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
  static Box3d box_of(const FiberStates& fibers, const Piece& piece);
  static void fetch(const FiberStates& fibers, const Piece& piece);
  void order_pieces(const FiberStates& fibers);

  template <class Call>
  static void for_each_piece(const FiberStates& fibers, const Call& call);

  std::vector<Piece> pieces_;          // by their places in the tree
  std::vector<std::uint32_t> places_;  // of the pieces, run by run
  BoxTree tree_;
};

template <class Call>
void PieceBoxes::for_each_near(const FiberStates& fibers, const NearPieces& others, double margin,
                               const Call& call) const {
  std::vector<std::uint32_t> near;  // places of those that are before some of the piece
  const auto is_near = [&](const GlobalSegment& segment, std::uint64_t point) {
    const BoxTree::Box box =
        others.tree.seen_from_origin(inflated(fibers.box_around(point, point + 1), margin));
    std::optional<SegmentBall> ball;
    return std::any_of(near.begin(), near.end(), [&](std::uint32_t place) {
      if (!others.tree.meets(place, box) || !(others.pieces[place].first < segment)) {
        return false;
      }
      if (!ball) {
        ball = ball_around(fibers, point);
      }
      return may_come_within(*ball, others.pieces[place].capsule, margin);
    });
  };
  tree_.for_each_near(
      others.tree, margin, [&](std::uint32_t place, const auto* first, const auto* last) {
        const Piece& piece = pieces_[place];
        const FiberRun& run = fibers.before.runs()[piece.run];
        const std::uint64_t end = end_of(piece, run);
        fetch(fibers, piece);
        const GlobalSegment last_segment{run.first.fiber, run.first.segment + end - 1};
        near.clear();
        std::copy_if(first, last, std::back_inserter(near), [&](std::uint32_t other) {
          return others.pieces[other].first < last_segment;
        });
        std::uint64_t begin = piece.begin;
        for (std::uint64_t i = begin; i <= end; ++i) {
          if (i < end && is_near({run.first.fiber, run.first.segment + i}, run.begin + i)) {
            continue;
          }
          if (begin < i) {
            call(piece.run, begin, i);
          }
          begin = i + 1;
        }
      });
}

}  // namespace fiber
