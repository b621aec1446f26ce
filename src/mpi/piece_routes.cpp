#include "src/mpi/piece_routes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "src/mpi/partition.hpp"

namespace fiber {
namespace {

// A piece goes to its owner as a whole. Shorter pieces fit space better, and take more memory each.
constexpr std::uint32_t segments_per_piece = 16;

// A rank sends so many nodes at a time: so they are not in memory twice.
constexpr std::size_t nodes_per_slice = std::size_t{1} << 16U;

}  // namespace

void PieceRoutes::set_parts(const Communicator& ranks, const FiberAssembly& parts,
                            const std::vector<FiberPart>& names) {
  chains_.emplace(ranks, parts, names);
  names_ = names;
  offsets_ = parts.offsets();
  pieces_.clear();
  for (std::uint32_t part = 0; part < names.size(); ++part) {
    const std::uint32_t count = offsets_[part + 1] - offsets_[part] - 1;
    for (std::uint32_t begin = 0; begin < count; begin += segments_per_piece) {
      pieces_.push_back({part, begin, std::min(segments_per_piece, count - begin)});
    }
  }
}

ArcLengths PieceRoutes::arc_lengths(const Communicator& ranks, const FiberAssembly& parts) const {
  return chains_->arc_lengths(ranks, parts, names_, segments_per_piece);
}

void PieceRoutes::split(const Communicator& ranks, const FiberAssembly& parts,
                        const std::vector<double>& costs) {
  const std::vector<double> of_ranks =
      ranks.gather_all(std::accumulate(costs.begin(), costs.end(), 0.0));
  const double all = std::accumulate(of_ranks.begin(), of_ranks.end(), 0.0);
  const std::uint64_t count = ranks.sum(costs.size());
  std::vector<PartitionObject> objects;
  for (const Piece& piece : pieces_) {
    double weight = piece.count;
    if (all > 0.0) {
      // Zoltan adds up in single precision: small whole numbers are exact for long.
      const double of_mean = costs[objects.size()] * static_cast<double>(count) / all;
      weight = std::clamp(std::round(segments_per_piece * of_mean), 1.0, 0x1p10);
    }
    objects.push_back(
        {parts.points()[first_point(piece) + piece.count / 2], static_cast<float>(weight)});
  }
  owners_ = partition(ranks, objects, ranks.size());
}

void PieceRoutes::keep_all(const Communicator& ranks) {
  owners_.assign(pieces_.size(), ranks.rank());
}

std::vector<FiberRun> PieceRoutes::send_runs(const Communicator& ranks) {
  PerRank<FiberRun> runs(static_cast<std::size_t>(ranks.size()));
  std::size_t i = 0;
  sent_points_ = 0;
  for (const Piece& piece : pieces_) {
    const FiberPart& name = names_[piece.part];
    const GlobalSegment first{name.fiber, name.first_segment + piece.begin};
    const int owner = owners_[i++];
    runs[static_cast<std::size_t>(owner)].push_back({first, piece.count, 0, 0.0});
    sent_points_ += owner == ranks.rank() ? 0 : piece.count + 1;
  }
  runs = ranks.exchange(std::move(runs));
  first_of_rank_.assign(1, 0);
  for (const std::vector<FiberRun>& some : runs) {
    first_of_rank_.push_back(first_of_rank_.back() + some.size());
  }
  return joined_runs(runs);
}

void PieceRoutes::send_nodes(const Communicator& ranks, const FiberAssembly& parts,
                             const std::vector<double>& arcs, LocalFibers& owned) const {
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<double> arcs_to(size);
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    arcs_to[static_cast<std::size_t>(owners_[i])].push_back(arcs[i]);
  }
  const PerRank<double> arcs_from = ranks.exchange(std::move(arcs_to));
  std::vector<std::size_t> next(size, 0);
  for (std::size_t i = 0; !ranks.all(i == pieces_.size());) {
    PerRank<FiberNode> to(size);
    for (std::vector<FiberNode>& nodes : to) {
      nodes.reserve(std::min(nodes_per_slice, 2 * nodes_per_slice / size));
    }
    for (std::size_t count = 0; i < pieces_.size() && count < nodes_per_slice; ++i) {
      std::vector<FiberNode>& nodes = to[static_cast<std::size_t>(owners_[i])];
      const std::uint32_t first = first_point(pieces_[i]);
      const std::uint32_t last = first + pieces_[i].count;
      for (std::uint32_t p = first; p <= last; ++p) {
        nodes.push_back({parts.points()[p], p < last ? parts.segment_radius(p) : 0.0});
      }
      count += last - first + 1;
    }
    const PerRank<FiberNode> from = ranks.exchange(std::move(to));
    for (std::size_t rank = 0; rank < size; ++rank) {
      const FiberNode* nodes = from[rank].data();
      while (nodes != from[rank].data() + from[rank].size()) {
        const double arc = arcs_from[rank][next[rank]];
        nodes = owned.place(first_of_rank_[rank] + next[rank]++, arc, nodes);
      }
    }
  }
  ranks.throw_on_all(error_in([&] { owned.close(); }));
}

std::vector<double> PieceRoutes::collect_costs(const Communicator& ranks, const LocalFibers& owned,
                                               const std::vector<double>& of_runs) const {
  PerRank<double> costs(static_cast<std::size_t>(ranks.size()));
  for (std::size_t other = 0; other < costs.size(); ++other) {
    for (std::size_t i = first_of_rank_[other]; i < first_of_rank_[other + 1]; ++i) {
      costs[other].push_back(of_runs[owned.sorted_index(i)]);
    }
  }
  costs = ranks.exchange(std::move(costs));
  std::vector<std::size_t> next(costs.size(), 0);
  std::vector<double> of_pieces;
  of_pieces.reserve(owners_.size());
  for (const int rank : owners_) {
    const auto owner = static_cast<std::size_t>(rank);
    of_pieces.push_back(costs[owner][next[owner]++]);
  }
  return of_pieces;
}

}  // namespace fiber
