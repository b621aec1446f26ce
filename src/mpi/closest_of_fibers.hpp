#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/kth_smallest.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// The closest pair of segments of two fibres, as far as it is known.
struct FiberPairMinimum {
  PairKey key;             ///< of global ids
  Contact contact;         ///< the same, by numbers of fibres here, if it is_here
  bool is_here = false;    ///< otherwise another rank reports it
  bool is_across = false;  ///< its segment b is another rank's
};

/// The closest pair of segments that this rank knows of each pair of fibres, and how close others
/// must be to matter.
class ClosestOfFibers {
 public:
  /// @param pair_count of fibres that may have one, over all ranks
  /// @param margin     [m]
  ClosestOfFibers(std::uint64_t pair_count, double margin)
      : pair_count_(pair_count), margin_(margin), bound_(margin) {}

  /// [m] Pairs of segments further apart than this do not matter, whatever their fibres. It is less
  /// than the margin once each pair of fibres has a minimum.
  double bound() const { return bound_; }

  /// The closest pair known of these fibres, nullptr for none.
  const FiberPairMinimum* find(std::uint64_t fiber_a, std::uint64_t fiber_b);

  /// [m] Pairs of segments of these fibres further apart than this do not matter.
  double bound_of(std::uint64_t fiber_a, std::uint64_t fiber_b) {
    const FiberPairMinimum* minimum = find(fiber_a, fiber_b);
    return minimum == nullptr ? bound_ : minimum->key.value;
  }

  /// Keeps a pair that is closer than what is known of its fibres.
  /// @return [m] the true gap of the pair that it replaces is at least this; infinity for none
  double keep(const FiberPairMinimum& minimum);

  const std::vector<FiberPairMinimum>& minima() const { return minima_; }

  /// Takes over what other ranks know. Collective.
  /// @param others_lower [m] is lowered to what is known of pairs that this rank does not report
  /// any more
  /// @return [m] bound() of what all ranks know together, in truth and as found
  double exchange(const Communicator& ranks, double& others_lower);

 private:
  using FiberPair = std::pair<std::uint64_t, std::uint64_t>;
  struct Hash {
    std::size_t operator()(const FiberPair& fibers) const;
  };

  /// Finds for each key the closest one that any rank has of the same two fibres. Collective.
  /// @param places of this rank, each of other fibres
  static std::vector<PairKey> closest_of_all(const Communicator& ranks,
                                             const std::vector<PairKey>& places);
  void lower_bound();

  const std::uint64_t pair_count_;
  const double margin_;  // [m]
  double bound_;         // [m]
  std::vector<FiberPairMinimum> minima_;
  std::unordered_map<FiberPair, std::size_t, Hash> places_;  // among the minima
  std::uint64_t changes_ = 0;                                // since the bound was looked for
  // Pairs of two fibres are found in a row:
  FiberPair last_;
  std::size_t last_place_ = none;

  static constexpr auto none = static_cast<std::size_t>(-1);
};

/// How many pairs of fibres may have a closest pair of segments, over all ranks. Collective.
std::uint64_t count_fiber_pairs(const Communicator& ranks, const LocalFibers& own, Pairing pairing);

}  // namespace fiber
