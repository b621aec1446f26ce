#include "fiber_proximity/query/simplified_engine.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "fiber_proximity/query/deadline.hpp"
#include "fiber_proximity/query/merge_results.hpp"
#include "fiber_proximity/query/pair_collector.hpp"
#include "fiber_proximity/query/unsimplified_pairs.hpp"
#include "src/query/checked_length.hpp"

namespace fiber {
namespace {

/// [m] At least the length of any segment and its diameter.
double size_of_segments(const FiberAssembly& fibers) {
  double length = 0.0;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t i = fibers.offsets()[fiber] + 1; i < fibers.offsets()[fiber + 1]; ++i) {
      const Eigen::Vector3d extent = fibers.points()[i] - fibers.points()[i - 1];
      length = std::max(length, extent.cwiseAbs().sum());
    }
  }
  return length + 2.0 * fibers.largest_radius();
}

/// What to ask the engine for: its fibres are segments or pieces of up to these sizes [m].
QueryOptions options_for_pieces(const QueryOptions& options, double size_a, double size_b) {
  QueryOptions for_pieces = options;
  for_pieces.neighbour_skip_length = 0.0;  // the rule of loops is for the fibres themselves
  if (options.kernel == Kernel::ROBUST) {
    // Twice what is proven of the error of a computed distance: that of the pieces may be above
    // the margin, that of the segments below. FAST and EXACT decide without error.
    for_pieces.margin += 0x1p-44 * (options.margin + size_a + size_b);
  }
  return for_pieces;
}

/// [s] The rest of the time is for what becomes of the answer.
double deadline_for_pieces(const Deadline& deadline) {
  constexpr double part = 0.8;
  return part * deadline.left();
}

void widen(double spread, Contact& contact) {
  if (spread > 0.0) {
    contact.upper = std::nextafter(contact.upper + spread, std::numeric_limits<double>::infinity());
  }
}

}  // namespace

SimplifiedEngine::SimplifiedEngine(std::unique_ptr<ProximityEngine> engine, double deviation)
    : engine_(std::move(engine)), deviation_(checked_length("simplification", deviation)) {}

std::size_t SimplifiedEngine::memory_bytes() const {
  return engine_->memory_bytes() + simplified_.memory_bytes();
}

void SimplifiedEngine::do_update(const FiberAssembly& fibers, bool /*same_topology*/) {
  simplified_.update(fibers, deviation_);
  size_ = size_of_segments(simplified_.assembly());
  engine_->update(simplified_.assembly());
}

void SimplifiedEngine::do_query(const FiberAssembly& fibers, const QueryOptions& options,
                                QueryResult& result) const {
  const Deadline deadline(options.deadline);
  UnsimplifiedPairs unsimplified(fibers, simplified_, options);
  QueryResult near;
  PairCollector collector(fibers, options, near);
  unsimplified.offer(collector);
  collector.finish();
  if (options.type == QueryType::FIRST && !near.contacts.empty()) {
    result = std::move(near);
    return;
  }
  QueryOptions for_pieces = options_for_pieces(options, size_, size_);
  for_pieces.neighbour_skip = unsimplified.neighbour_skip();
  for_pieces.deadline = deadline_for_pieces(deadline);
  engine_->query(for_pieces, result);
  for (Contact& contact : result.contacts) {
    restore_a(fibers, contact);
    restore_b(fibers, contact);
  }
  merge_results(options, near, result);
}

void SimplifiedEngine::do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                                      const QueryOptions& options, QueryResult& result) const {
  const Deadline deadline(options.deadline);
  QueryOptions for_pieces = options_for_pieces(options, size_of_segments(shape), size_);
  for_pieces.deadline = deadline_for_pieces(deadline);
  engine_->query_shape(shape, for_pieces, result);
  for (Contact& contact : result.contacts) {
    restore_b(fibers, contact);
  }
  sort_by_key(result.contacts);
}

/// Makes a of the contact, a piece, a segment of the run that it stands for, of the run's
/// thickness.
void SimplifiedEngine::restore_a(const FiberAssembly& fibers, Contact& contact) const {
  const double deviation = restore(fibers, contact.fiber_a, contact.segment_a, contact.s, contact);
  contact.point_a -= deviation * contact.normal;
}

/// The same of b.
void SimplifiedEngine::restore_b(const FiberAssembly& fibers, Contact& contact) const {
  const double deviation = restore(fibers, contact.fiber_b, contact.segment_b, contact.t, contact);
  contact.point_b += deviation * contact.normal;
}

/// What a and b have in common.
/// @param segment, s of the contact
/// @return by what the surface of the piece is further out [m]
double SimplifiedEngine::restore(const FiberAssembly& fibers, std::uint32_t fiber,
                                 std::uint32_t& segment, double& s, Contact& contact) const {
  const std::uint32_t piece = simplified_.assembly().offsets()[fiber] + segment;
  const SimplifiedFibers::Place place = simplified_.place(fibers, piece, s);
  segment = place.point - fibers.offsets()[fiber];
  s = place.s;
  const double deviation = simplified_.deviation(piece);
  contact.distance += deviation;
  widen(simplified_.spread(piece), contact);
  return deviation;
}

void SimplifiedEngine::do_update_motion(const FiberAssembly& before, const FiberAssembly& after,
                                        bool /*same_topology*/) {
  engine_->update_motion(before, after);
}

void SimplifiedEngine::do_query_motion(const MotionOptions& options, MotionResult& result) const {
  engine_->query_motion(options, result);
}

void SimplifiedEngine::do_query_motion_shape(const FiberAssembly& shape_before,
                                             const FiberAssembly& shape_after,
                                             const MotionOptions& options,
                                             MotionResult& result) const {
  engine_->query_motion_shape(shape_before, shape_after, options, result);
}

}  // namespace fiber
