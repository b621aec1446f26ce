#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// Candidates of a query, kept for those after it; several threads may ask at the same time.
class CandidateCache {
 public:
  using Keys = std::shared_ptr<std::vector<std::uint64_t>>;

  enum class State {
    NONE,   ///< nobody is to have them any more; their memory is kept
    STALE,  ///< those of some segments are to be replaced
    CURRENT
  };

  /// Of the ones that are kept.
  State state() const;

  /// Makes them worse: CURRENT ones STALE or NONE, STALE ones NONE.
  void become(State worse);

  /// Those in this state of a query of the same margin, neighbour skip and pairing; null if there
  /// are none.
  Keys find(const QueryOptions& options, State state) const;

  /// Where to put new ones: memory that nobody else uses.
  Keys make();

  /// Keeps them, as CURRENT ones, for such queries.
  void keep(const QueryOptions& options, const Keys& keys);

  std::size_t memory_bytes() const;

 private:
  mutable std::mutex mutex_;
  State state_ = State::NONE;
  double margin_ = 0.0;  // [m]
  std::optional<std::uint32_t> neighbour_skip_;
  Pairing pairing_ = Pairing::ALL;
  Keys keys_;
  Keys spare_;  // the ones before, for their memory
};

}  // namespace fiber
