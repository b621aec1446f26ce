#include "src/mpi/piece_boxes.hpp"

#include <algorithm>
#include <utility>

namespace fiber {

void PieceBoxes::update(const NamedFibers& fibers, bool are_same) {
  const auto box_of = [&](std::uint32_t number) {
    const Piece& piece = pieces_[number];
    const FiberRun& run = fibers.runs()[piece.run];
    const PlainPoint start = plain(fibers.fibers().points()[run.begin + piece.begin]);
    PlainBox box{start, start};
    double radius = 0.0;
    for (std::uint64_t p = run.begin + piece.begin; p < run.begin + end_of(piece, run); ++p) {
      const PlainPoint end = plain(fibers.fibers().points()[p + 1]);
      box = merged(box, {end, end});
      radius = std::max(radius, fibers.fibers().segment_radius(static_cast<std::uint32_t>(p)));
    }
    return inflated(box, radius);
  };
  if (are_same) {
    tree_.refit(box_of);
    return;
  }
  pieces_.clear();
  std::vector<SegmentBox> boxes;
  const std::size_t most =
      fibers.fibers().segment_count() / segments_per_piece + fibers.runs().size();
  pieces_.reserve(most);
  boxes.reserve(most);
  for (std::uint32_t i = 0; i < fibers.runs().size(); ++i) {
    const FiberRun& run = fibers.runs()[i];
    for (std::uint32_t begin = 0; begin < run.count; begin += segments_per_piece) {
      pieces_.push_back({i, begin});
      boxes.push_back({box_of(static_cast<std::uint32_t>(boxes.size())),
                       {run.first.fiber, run.first.segment + begin}});
    }
  }
  tree_ = BoxTree(std::move(boxes));
}

}  // namespace fiber
