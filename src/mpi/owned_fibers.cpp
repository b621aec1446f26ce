#include "src/mpi/owned_fibers.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "src/mpi/part_topology.hpp"

namespace fiber {

void OwnedFibers::take_runs(const Communicator& ranks) {
  std::vector<FiberRun> runs = routes_.send_runs(ranks);
  ranks.throw_on_all(error_in([&] { own_.assign(std::move(runs)); }));
  ++displacement_.layout;
}

void OwnedFibers::take(const Communicator& ranks, const FiberAssembly& parts,
                       const FiberAssembly* after, const std::vector<FiberPart>& names,
                       const FiberTopology& given, const RankLoad& load) {
  FiberTopology topology;
  const std::string error = error_in([&] { topology = part_topology(parts, given); });
  const bool is_same = ranks.all(error.empty() && has_fibers_ && routes_.is_of(parts, names) &&
                                 joined_.is_of(topology));
  has_fibers_ = false;
  ranks.throw_on_all(names.size() == parts.fiber_count()
                         ? error
                         : std::to_string(names.size()) + " names for " +
                               std::to_string(parts.fiber_count()) +
                               " parts, there must be one per part");
  ranks.throw_on_all(
      after == nullptr || after->has_topology_of(parts) ? ""
      : after->offsets() == parts.offsets()
          ? "the parts after the motion are not joined as before it"
          : "the parts after the motion are not of the same numbers of points as before it");
  if (!is_same) {
    routes_.set_parts(ranks, parts, names);
    joined_.set_parts(ranks, parts, names, topology);
  }
  const ArcLengths arcs = routes_.arc_lengths(ranks, parts);
  arc_roundings_ = arcs.roundings;
  const bool is_uneven = is_same && balance_.is_too_uneven(ranks.gather_all(load.cost));
  const bool is_split_anew = !is_same || is_uneven;
  if (is_split_anew) {
    const std::vector<double> costs = is_uneven
                                          ? routes_.collect_costs(ranks, own_, load.costs_of_runs())
                                          : std::vector<double>();
    routes_.split(ranks, parts, costs);
    balance_.note_split(is_uneven);
    take_runs(ranks);
    joined_.set_owners(ranks, parts, names, routes_);
  } else {
    own_.open();
  }
  routes_.send_nodes(ranks, parts, arcs.of_pieces, own_);
  if (after != nullptr) {
    if (is_split_anew || !do_move_) {
      own_after_ = own_;
    }
    own_after_.open();
    routes_.send_nodes(ranks, *after, arcs.of_pieces, own_after_);
    joined_.send_nodes(ranks, *after);  // only to see that what is joined meets there, too
  } else if (do_move_) {
    own_after_ = LocalFibers();
  }
  joined_.send_nodes(ranks, parts);
  const double moved = ranks.max(own_.moved());
  if (do_move_ || after != nullptr || std::isinf(moved)) {
    begin_epoch();
  } else {
    if (moved > 0.0) {
      // Rounded up, so that a difference of two sums is no less than what was added between.
      displacement_.length =
          std::nextafter(displacement_.length + moved, std::numeric_limits<double>::infinity());
    }
    displacement_.last = moved;
  }
  do_move_ = after != nullptr;
  has_fibers_ = true;
}

DistributedFibers OwnedFibers::adopt(const Communicator& ranks) {
  DistributedFibers own{own_.fibers(), {}};
  own.topology = joined_.topology_of(own_);
  own.names.reserve(own_.first_ids().size());
  for (const GlobalSegment& first : own_.first_ids()) {
    own.names.push_back({first.fiber, first.segment});
  }
  routes_.set_parts(ranks, own.parts, own.names);
  joined_.set_parts(ranks, own.parts, own.names, own.topology);
  const ArcLengths arcs = routes_.arc_lengths(ranks, own.parts);
  routes_.keep_all(ranks);
  take_runs(ranks);
  routes_.send_nodes(ranks, own.parts, arcs.of_pieces, own_);
  joined_.set_owners(ranks, own.parts, own.names, routes_);
  joined_.send_nodes(ranks, own.parts);
  begin_epoch();
  return own;
}

const PieceBoxes& OwnedFibers::fit_boxes() {
  if (boxes_fitted_.epoch != displacement_.epoch || boxes_fitted_.length != displacement_.length) {
    boxes_.update(states(), boxes_fitted_.layout == displacement_.layout);
    boxes_fitted_ = displacement_;
  }
  return boxes_;
}

Box3d OwnedFibers::around() const {
  assert(boxes_fitted_.epoch == displacement_.epoch && !boxes_.tree().empty());
  return inflated(boxes_.tree().root(),
                  (1.0 + 0x1p-40) * (displacement_.length - boxes_fitted_.length));
}

}  // namespace fiber
