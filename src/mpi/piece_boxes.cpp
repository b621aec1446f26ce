#include "src/mpi/piece_boxes.hpp"

#include <limits>
#include <numeric>
#include <utility>

namespace fiber {
namespace {

/// The first point and the last one of segments that follow each other.
struct PointSpan {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

}  // namespace

PlainBox PieceBoxes::box_of(const FiberStates& fibers, const Piece& piece) {
  const FiberRun& run = fibers.before.runs()[piece.run];
  return fibers.box_around(run.begin + piece.begin, run.begin + end_of(piece, run));
}

double PieceBoxes::mean_side() const {
  double sum = 0.0;
  for (std::uint32_t place = 0; place < numbers_.size(); ++place) {
    const PlainBox& box = tree_.box(place).box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum += box.upper[axis] - box.lower[axis];
    }
  }
  return numbers_.empty() ? std::numeric_limits<double>::infinity()
                          : sum / (3.0 * static_cast<double>(numbers_.size()));
}

std::vector<PieceCapsule> PieceBoxes::capsules(const FiberStates& fibers,
                                               const std::vector<std::uint32_t>& places) const {
  // Pieces that are near each other in space are not in memory. What they need is on its way while
  // others are computed.
  constexpr std::size_t ahead = 8;
  std::vector<PointSpan> spans;
  spans.reserve(places.size());
  for (const std::uint32_t place : places) {
    const Piece& piece = pieces_[numbers_[place]];
    const FiberRun& run = fibers.before.runs()[piece.run];
    spans.push_back({run.begin + piece.begin, run.begin + end_of(piece, run)});
  }
  std::vector<PieceCapsule> capsules;
  capsules.reserve(places.size());
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (i + ahead < spans.size()) {
      fibers.fetch(spans[i + ahead].begin, spans[i + ahead].end);
    }
    capsules.push_back(capsule_around(fibers, spans[i].begin, spans[i].end));
  }
  return capsules;
}

NearPieces PieceBoxes::all(const FiberStates& fibers) const {
  std::vector<std::uint32_t> places(numbers_.size());
  std::iota(places.begin(), places.end(), 0U);
  return {tree_, capsules(fibers, places)};
}

void PieceBoxes::update(const FiberStates& fibers, bool are_same) {
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
      fibers.before.fibers().segment_count() / segments_per_piece + fibers.before.runs().size();
  pieces_.reserve(most);
  boxes.reserve(most);
  for (std::uint32_t i = 0; i < fibers.before.runs().size(); ++i) {
    const FiberRun& run = fibers.before.runs()[i];
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
