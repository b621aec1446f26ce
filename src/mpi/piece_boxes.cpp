#include "src/mpi/piece_boxes.hpp"

#include <utility>

namespace fiber {

PlainBox PieceBoxes::box_of(const NamedFibers& fibers, const Piece& piece) {
  const FiberRun& run = fibers.runs()[piece.run];
  const Eigen::Vector3d* const points = fibers.fibers().points().data() + run.begin;
  Eigen::Array3d lower = points[piece.begin];
  Eigen::Array3d upper = lower;
  double radius = 0.0;
  for (std::uint64_t i = piece.begin; i < end_of(piece, run); ++i) {
    lower = lower.min(points[i + 1].array());
    upper = upper.max(points[i + 1].array());
    radius =
        std::max(radius, fibers.fibers().segment_radius(static_cast<std::uint32_t>(run.begin + i)));
  }
  return inflated({{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}, radius);
}

void PieceBoxes::update(const NamedFibers& fibers, bool are_same) {
  if (are_same) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      tree_.move(places_[i], box_of(fibers, pieces_[i]));
    }
    tree_.close();
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
      boxes.push_back(
          {box_of(fibers, pieces_.back()), {run.first.fiber, run.first.segment + begin}});
    }
  }
  numbers_ = spatial_order(boxes);
  places_.resize(numbers_.size());
  std::vector<SegmentBox> in_order;
  in_order.reserve(boxes.size());
  for (std::uint32_t place = 0; place < numbers_.size(); ++place) {
    places_[numbers_[place]] = place;
    in_order.push_back(boxes[numbers_[place]]);
  }
  tree_ = BoxTree(std::move(in_order));
}

}  // namespace fiber
