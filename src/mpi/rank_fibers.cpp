#include "src/mpi/rank_fibers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "src/mpi/partition.hpp"

namespace fiber {
namespace {

// What goes to a rank as a whole. Shorter pieces fit space better, and take more memory each.
constexpr std::uint32_t segments_per_piece = 16;

// How many nodes a rank sends at a time: so they are not there twice.
constexpr std::size_t nodes_per_slice = std::size_t{1} << 16U;

// The most that the cost of one rank may be of the mean, beside what the last split reached.
constexpr double max_imbalance = 1.1;

/// Goes through the pieces of parts, one after another.
class PieceCursor {
 public:
  explicit PieceCursor(const std::vector<std::uint32_t>& offsets) : offsets_(offsets) {}

  bool is_over() const { return part_ + 1 >= offsets_.size(); }
  std::size_t part() const { return part_; }
  std::uint32_t first_point() const { return offsets_[part_] + begin_; }
  std::uint32_t first_segment() const { return begin_; }  ///< along the part
  std::uint32_t count() const { return std::min(segments_per_piece, segments() - begin_); }

  void go_on() {
    begin_ += segments_per_piece;
    if (begin_ >= segments()) {
      ++part_;
      begin_ = 0;
    }
  }

 private:
  std::uint32_t segments() const { return offsets_[part_ + 1] - offsets_[part_] - 1; }

  const std::vector<std::uint32_t>& offsets_;
  std::size_t part_ = 0;
  std::uint32_t begin_ = 0;
};

}  // namespace

void RankFibers::name_parts(const Communicator& ranks, const FiberAssembly& parts,
                            const std::vector<FiberPart>& names) {
  chains_.emplace(ranks, parts, names);
  names_ = names;
  offsets_ = parts.offsets();
}

bool RankFibers::is_as_before(const FiberAssembly& parts,
                              const std::vector<FiberPart>& names) const {
  return has_fibers_ && offsets_ == parts.offsets() && names_ == names;
}

/// What is too much for a rank. What a split by costs could not even out is not tried again.
bool RankFibers::is_too_uneven(const std::vector<double>& costs) {
  const double mean =
      std::accumulate(costs.begin(), costs.end(), 0.0) / static_cast<double>(costs.size());
  const double most = *std::max_element(costs.begin(), costs.end());
  if (mean <= 0.0) {
    return false;
  }
  if (!evenness_is_known_) {
    evenness_is_known_ = true;
    best_imbalance_ = most / mean;
  }
  return most > max_imbalance * best_imbalance_ * mean;
}

/// Of the pieces that this rank brings, in their order, what their owners say.
std::vector<double> RankFibers::costs_of_pieces(const Communicator& ranks,
                                                const RankLoad& load) const {
  const std::vector<double> of_runs = load.costs_of_runs();
  PerRank<double> costs(static_cast<std::size_t>(ranks.size()));
  for (std::size_t other = 0; other < costs.size(); ++other) {
    for (std::size_t i = first_of_rank_[other]; i < first_of_rank_[other + 1]; ++i) {
      costs[other].push_back(of_runs[own_.sorted_index(i)]);
    }
  }
  costs = ranks.exchange(std::move(costs));
  std::vector<std::size_t> next(costs.size(), 0);
  std::vector<double> of_pieces;
  of_pieces.reserve(destinations_.size());
  for (const int destination : destinations_) {
    const auto owner = static_cast<std::size_t>(destination);
    of_pieces.push_back(costs[owner][next[owner]++]);
  }
  return of_pieces;
}

/// @param costs of the pieces that this rank brings; empty: as many as they have segments
void RankFibers::split(const Communicator& ranks, const FiberAssembly& parts,
                       const std::vector<double>& costs) {
  const std::vector<double> of_ranks =
      ranks.gather_all(std::accumulate(costs.begin(), costs.end(), 0.0));
  const double all = std::accumulate(of_ranks.begin(), of_ranks.end(), 0.0);
  const std::uint64_t count = ranks.sum(costs.size());
  std::vector<PartitionObject> objects;
  for (PieceCursor piece(offsets_); !piece.is_over(); piece.go_on()) {
    double weight = piece.count();
    if (all > 0.0) {
      // Zoltan adds up in single precision: small whole numbers are exact for long.
      const double of_mean = costs[objects.size()] * static_cast<double>(count) / all;
      weight = std::clamp(std::round(segments_per_piece * of_mean), 1.0, 0x1p10);
    }
    objects.push_back({plain(parts.points()[piece.first_point() + piece.count() / 2]),
                       static_cast<float>(weight)});
  }
  destinations_ = partition(ranks, objects, ranks.size());
  ++split_count_;
}

/// Gives all pieces to whom they belong now, but for their nodes.
void RankFibers::hand_over(const Communicator& ranks) {
  PerRank<FiberRun> runs(static_cast<std::size_t>(ranks.size()));
  std::size_t i = 0;
  sent_points_ = 0;
  for (PieceCursor piece(offsets_); !piece.is_over(); piece.go_on()) {
    const FiberPart& name = names_[piece.part()];
    const GlobalSegment first{name.fiber, name.first_segment + piece.first_segment()};
    const int to = destinations_[i++];
    runs[static_cast<std::size_t>(to)].push_back({first, piece.count(), 0, 0.0});
    sent_points_ += to == ranks.rank() ? 0 : piece.count() + 1;
  }
  runs = ranks.exchange(std::move(runs));
  first_of_rank_.assign(1, 0);
  for (const std::vector<FiberRun>& some : runs) {
    first_of_rank_.push_back(first_of_rank_.back() + some.size());
  }
  ranks.throw_on_all(error_in([&] { own_.assign(joined_runs(runs)); }));
  ++hand_over_count_;
}

/// Sends the nodes of all pieces to whom they belong.
/// @param arcs  [m] of the pieces
/// @param owned of this rank: its runs, open
void RankFibers::send_nodes(const Communicator& ranks, const FiberAssembly& parts,
                            const std::vector<double>& arcs, LocalFibers& owned) const {
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<double> arcs_to(size);
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    arcs_to[static_cast<std::size_t>(destinations_[i])].push_back(arcs[i]);
  }
  const PerRank<double> arcs_from = ranks.exchange(std::move(arcs_to));
  std::vector<std::size_t> next(size, 0);
  PieceCursor piece(offsets_);
  for (std::size_t i = 0; !ranks.all(piece.is_over());) {
    PerRank<FiberNode> to(size);
    for (std::vector<FiberNode>& nodes : to) {
      nodes.reserve(std::min(nodes_per_slice, 2 * nodes_per_slice / size));
    }
    for (std::size_t count = 0; !piece.is_over() && count < nodes_per_slice; piece.go_on()) {
      std::vector<FiberNode>& nodes = to[static_cast<std::size_t>(destinations_[i++])];
      const std::uint32_t last = piece.first_point() + piece.count();
      for (std::uint32_t p = piece.first_point(); p <= last; ++p) {
        nodes.push_back({plain(parts.points()[p]), p < last ? parts.segment_radius(p) : 0.0});
      }
      count += piece.count() + 1;
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

void RankFibers::take(const Communicator& ranks, const FiberAssembly& parts,
                      const FiberAssembly* after, const std::vector<FiberPart>& names,
                      const RankLoad& load) {
  const bool is_same = ranks.all(is_as_before(parts, names));
  has_fibers_ = false;
  ranks.throw_on_all(names.size() == parts.fiber_count()
                         ? ""
                         : std::to_string(names.size()) + " names for " +
                               std::to_string(parts.fiber_count()) +
                               " parts, there must be one per part");
  ranks.throw_on_all(
      after == nullptr || after->offsets() == parts.offsets()
          ? ""
          : "the parts after the motion are not of the same numbers of points as before it");
  if (!is_same) {
    name_parts(ranks, parts, names);
  }
  const ArcLengths arcs = chains_->arc_lengths(ranks, parts, names, segments_per_piece);
  arc_roundings_ = arcs.roundings;
  const bool is_uneven = is_same && is_too_uneven(ranks.gather_all(load.cost));
  const bool are_split_anew = !is_same || is_uneven;
  if (are_split_anew) {
    split(ranks, parts, is_uneven ? costs_of_pieces(ranks, load) : std::vector<double>());
    hand_over(ranks);
    evenness_is_known_ = !is_uneven;
    best_imbalance_ = 1.0;
  } else {
    own_.open();
  }
  send_nodes(ranks, parts, arcs.of_pieces, own_);
  if (after != nullptr) {
    if (are_split_anew || !do_move_) {
      own_after_ = own_;
    }
    own_after_.open();
    send_nodes(ranks, *after, arcs.of_pieces, own_after_);
  } else if (do_move_) {
    own_after_ = LocalFibers();
  }
  const double moved = ranks.max(own_.moved());
  if (do_move_ || after != nullptr || std::isinf(moved)) {
    displacement_ = {displacement_.epoch + 1, 0.0, 0.0};
  } else {
    // Rounded up, so that a difference of two sums is no less than what was added between.
    const double length = moved == 0.0 ? displacement_.length
                                       : std::nextafter(displacement_.length + moved,
                                                        std::numeric_limits<double>::infinity());
    displacement_ = {displacement_.epoch, length, moved};
  }
  do_move_ = after != nullptr;
  has_fibers_ = true;
}

DistributedFibers RankFibers::adopt(const Communicator& ranks) {
  DistributedFibers own{own_.fibers(), {}};
  own.names.reserve(own_.first_ids().size());
  for (const GlobalSegment& first : own_.first_ids()) {
    own.names.push_back({first.fiber, first.segment});
  }
  name_parts(ranks, own.parts, own.names);
  const ArcLengths arcs = chains_->arc_lengths(ranks, own.parts, own.names, segments_per_piece);
  destinations_.assign(arcs.of_pieces.size(), ranks.rank());
  hand_over(ranks);
  send_nodes(ranks, own.parts, arcs.of_pieces, own_);
  displacement_ = {displacement_.epoch + 1, 0.0, 0.0};
  return own;
}

const PieceBoxes& RankFibers::fit_boxes() {
  if (boxes_displacement_.epoch != displacement_.epoch ||
      boxes_displacement_.length != displacement_.length) {
    boxes_.update(states(), boxes_hand_over_ == hand_over_count_);
    boxes_hand_over_ = hand_over_count_;
    boxes_displacement_ = displacement_;
  }
  return boxes_;
}

PlainBox RankFibers::around() const {
  assert(boxes_displacement_.epoch == displacement_.epoch && !boxes_.tree().empty());
  return inflated(boxes_.tree().root(),
                  (1.0 + 0x1p-40) * (displacement_.length - boxes_displacement_.length));
}

}  // namespace fiber
