#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/joined_pairs.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/loop_questions.hpp"

namespace fiber {

/// Options with which an engine that has stretches of fibres leaves out no pair of those that the
/// options ask for. Some that it finds are none along whole fibres.
/// @param arc_roundings see OwnedFibers
inline PairOptions options_of_stretches(const PairOptions& options, double arc_roundings) {
  PairOptions here = options;
  here.contact_limit = 0;
  if (options.pairing == Pairing::SAME_FIBER) {
    here.pairing = Pairing::ALL;  // stretches of one fibre may be several here
  }
  if (!options.needs_loops()) {
    here.neighbour_skip = options.neighbour_skip.value_or(1);
    // Sums along a stretch are rounded in another way than those along the whole fibre.
    const double surely =
        (1.0 - 0x1p-50) * options.neighbour_skip_length.value_or(0.0) - 0x1p-48 * arc_roundings;
    here.neighbour_skip_length = std::max(0.0, surely);
  }
  return here;
}

/// The part of a limit of pairs that is left, at least one; 0 stays none.
inline std::uint64_t rest_of(std::uint64_t limit, std::uint64_t taken) {
  return limit == 0 ? 0 : std::max<std::uint64_t>(1, limit - std::min(limit, taken));
}

/// The segments that a rank looks for pairs of: a is one of its own, b an own one or one of its
/// halo.
struct RankPairs {
  const Communicator& ranks;
  const LocalFibers& own;
  const LocalFibers& halo;
  const JoinedPairs& joined;

  /// Whether segments are no pair along whole fibres, loops and joints apart.
  bool are_left_out(const PairOptions& options, const SegmentIdPair& pair,
                    const LocalFibers& fibers_b) const {
    const GlobalSegment a = own.global_id(pair.fiber_a, pair.segment_a);
    const GlobalSegment b = fibers_b.global_id(pair.fiber_b, pair.segment_b);
    if (a.fiber != b.fiber) {
      return options.pairing == Pairing::SAME_FIBER;
    }
    if (options.pairing == Pairing::DIFFERENT_FIBERS ||
        b.segment - a.segment <= options.neighbour_skip.value_or(1)) {
      return true;
    }
    const double min_length = options.neighbour_skip_length.value_or(0.0);
    return min_length > 0.0 && fibers_b.arc(fibers_b.point_of(pair.fiber_b, pair.segment_b)) -
                                       own.arc(own.point_of(pair.fiber_a, pair.segment_a) + 1) <
                                   min_length;
  }

  /// Leaves of what an engine found those that are pairs along whole fibres. Collective.
  /// @param found    pairs of a segment of own and one of fibers_b, which is one of the two
  template <class Found>
  void keep_those_of_whole_fibers(const PairOptions& options, const LocalFibers& fibers_b,
                                  std::vector<Found>& found) const;
};

template <class Found>
void RankPairs::keep_those_of_whole_fibers(const PairOptions& options, const LocalFibers& fibers_b,
                                           std::vector<Found>& found) const {
  std::vector<LoopQuestion> questions;
  std::vector<std::size_t> asked;  // places of theirs among those kept
  std::size_t kept = 0;
  const auto keep = [&](std::size_t i) {
    if (kept != i) {
      found[kept] = found[i];
    }
    ++kept;
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Found& pair = found[i];
    if (are_left_out(options, pair, fibers_b)) {
      continue;
    }
    const GlobalSegment a = own.global_id(pair.fiber_a, pair.segment_a);
    const GlobalSegment b = fibers_b.global_id(pair.fiber_b, pair.segment_b);
    if (const std::optional<PointPair> points = joined.points_of(a, b)) {
      if (!joined.are_left_out(*points)) {
        keep(i);
      }
      continue;
    }
    // The engine has seen the loop if both segments are on one stretch of the fibre.
    const bool is_loop_known = &fibers_b == &own && pair.fiber_a == pair.fiber_b;
    if (options.needs_loops() && a.fiber == b.fiber && !is_loop_known) {
      asked.push_back(kept);
      questions.push_back(
          {a.fiber, a.segment, b.segment,
           own.fibers().capsule(own.point_of(pair.fiber_a, pair.segment_a)),
           fibers_b.fibers().capsule(fibers_b.point_of(pair.fiber_b, pair.segment_b))});
    }
    keep(i);
  }
  found.resize(kept);
  const std::vector<bool> loops = find_loops(ranks, own, halo, questions);
  kept = 0;
  auto next = asked.begin();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool is_asked = next != asked.end() && *next == i;
    if (!is_asked || loops[static_cast<std::size_t>(next - asked.begin())]) {
      keep(i);
    }
    next += is_asked ? 1 : 0;
  }
  found.resize(kept);
}

}  // namespace fiber
