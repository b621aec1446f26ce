#include "src/mpi/piece_boxes.hpp"

#include <limits>
#include <numeric>

namespace fiber {
namespace {

// Pieces that are near each other in space are not in memory. What they need is on its way while
// others are looked at.
constexpr std::size_t ahead = 8;

}  // namespace

Box3d PieceBoxes::box_of(const FiberStates& fibers, const Piece& piece) {
  const FiberRun& run = fibers.before.runs()[piece.run];
  return fibers.box_around(run.begin + piece.begin, run.begin + end_of(piece, run));
}

void PieceBoxes::fetch(const FiberStates& fibers, const Piece& piece) {
  const FiberRun& run = fibers.before.runs()[piece.run];
  fibers.fetch(run.begin + piece.begin, run.begin + end_of(piece, run));
}

double PieceBoxes::mean_side() const {
  double sum = 0.0;
  for (std::uint32_t place = 0; place < pieces_.size(); ++place) {
    for (const double side : tree_.box(place).sizes().eval()) {
      sum += side;
    }
  }
  return pieces_.empty() ? std::numeric_limits<double>::infinity()
                         : sum / (3.0 * static_cast<double>(pieces_.size()));
}

std::vector<NearPiece> PieceBoxes::pieces(const FiberStates& fibers,
                                          const std::vector<std::uint32_t>& places) const {
  std::vector<NearPiece> near;
  near.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i + ahead < places.size()) {
      fetch(fibers, pieces_[places[i + ahead]]);
    }
    const Piece& piece = pieces_[places[i]];
    const FiberRun& run = fibers.before.runs()[piece.run];
    near.push_back(
        {{run.first.fiber, run.first.segment + piece.begin},
         capsule_around(fibers, run.begin + piece.begin, run.begin + end_of(piece, run))});
  }
  return near;
}

NearPieces PieceBoxes::all(const FiberStates& fibers) const {
  std::vector<std::uint32_t> places(pieces_.size());
  std::iota(places.begin(), places.end(), 0U);
  return {tree_, pieces(fibers, places)};
}

/// Run by run, as points are in memory.
template <class Call>
void PieceBoxes::for_each_piece(const FiberStates& fibers, const Call& call) {
  const std::vector<FiberRun>& runs = fibers.before.runs();
  for (std::uint32_t run = 0; run < runs.size(); ++run) {
    for (std::uint32_t begin = 0; begin < runs[run].count; begin += segments_per_piece) {
      call(Piece{run, begin});
    }
  }
}

/// Makes a tree with places for the pieces of these fibres.
void PieceBoxes::order_pieces(const FiberStates& fibers) {
  std::vector<Piece> by_runs;
  std::vector<Box3d> boxes;
  const std::size_t max_pieces =
      fibers.before.fibers().segment_count() / segments_per_piece + fibers.before.runs().size();
  by_runs.reserve(max_pieces);
  boxes.reserve(max_pieces);
  for_each_piece(fibers, [&](const Piece& piece) {
    by_runs.push_back(piece);
    boxes.push_back(box_of(fibers, piece));
  });
  const std::vector<std::uint32_t> numbers = spatial_order(boxes);
  tree_ = BoxTree(boxes.size(), union_of(boxes));
  boxes = {};
  pieces_.resize(by_runs.size());
  places_.resize(by_runs.size());
  for (std::uint32_t place = 0; place < numbers.size(); ++place) {
    pieces_[place] = by_runs[numbers[place]];
    places_[numbers[place]] = place;
  }
}

void PieceBoxes::update(const FiberStates& fibers, bool are_same) {
  if (!are_same) {
    order_pieces(fibers);
  }
  auto place = places_.begin();
  for_each_piece(fibers, [&](const Piece& piece) { tree_.put(*place++, box_of(fibers, piece)); });
  tree_.close();
}

}  // namespace fiber
