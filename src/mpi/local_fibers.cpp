#include "src/mpi/local_fibers.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace fiber {
namespace {

struct Piece {
  GlobalSegment first;
  std::uint64_t count = 0;
  const FiberNode* nodes = nullptr;
  bool is_own = false;
};

void append_pieces(const FiberRuns& set, bool is_own, std::vector<Piece>& pieces) {
  for (const FiberRun& run : set.runs) {
    pieces.push_back({run.first, run.count, set.nodes.data() + run.begin, is_own});
  }
}

}  // namespace

void LocalFibers::assign(const FiberRuns& own, const FiberRuns& halo) {
  const std::size_t most = own.nodes.size() + halo.nodes.size();
  if (most > std::numeric_limits<std::int32_t>::max()) {
    throw std::invalid_argument("this rank would hold " + std::to_string(most) +
                                " points with its halo, it can hold " +
                                std::to_string(std::numeric_limits<std::int32_t>::max()) +
                                ": take more ranks or a smaller margin");
  }
  std::vector<Piece> pieces;
  pieces.reserve(own.runs.size() + halo.runs.size());
  append_pieces(own, true, pieces);
  append_pieces(halo, false, pieces);
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& x, const Piece& y) { return x.first < y.first; });

  points_.clear();
  radii_.clear();
  offsets_.assign(1, 0);
  points_.reserve(most);
  radii_.reserve(most);
  first_.clear();
  is_own_.clear();
  arcs_.clear();
  const auto append = [&](const FiberNode& node, bool is_own) {
    points_.push_back(vector_of(node.point));
    radii_.push_back(node.radius);
    arcs_.push_back(node.arc);
    is_own_.push_back(is_own ? 1 : 0);
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    const GlobalSegment next{piece.first.fiber, piece.first.segment + piece.count};
    const bool goes_on = i + 1 < pieces.size() && pieces[i + 1].first.key() == next.key();
    if (points_.size() == offsets_.back()) {
      first_.push_back(piece.first);
    }
    // Of two pieces that meet, the point between belongs to the segment that starts there.
    for (std::uint64_t k = 0; k < piece.count + (goes_on ? 0 : 1); ++k) {
      append(piece.nodes[k], piece.is_own && k < piece.count);
    }
    if (!goes_on) {
      offsets_.push_back(static_cast<std::uint32_t>(points_.size()));
    }
  }
  if (points_.empty()) {
    fibers_ = FiberAssembly();
  } else {
    fibers_.assign_segments(points_, offsets_, radii_);
  }
}

}  // namespace fiber
