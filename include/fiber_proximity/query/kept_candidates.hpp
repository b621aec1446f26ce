#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// Candidates of a query, kept for those after it; several threads may ask at the same time.
class KeptCandidates {
 public:
  using Keys = std::shared_ptr<std::vector<std::uint64_t>>;

  /// Nobody is to have the ones there are any more; their memory is kept.
  void forget();

  /// Those of a query of the same margin and neighbour skip; null if there are none.
  Keys find(const QueryOptions& options) const;

  /// Where to put new ones: memory that nobody else uses.
  Keys make();

  /// Keeps them for such queries.
  void keep(const QueryOptions& options, const Keys& keys);

  std::size_t memory_bytes() const;

 private:
  mutable std::mutex mutex_;
  bool valid_ = false;
  double margin_ = 0.0;  // [m]
  std::uint32_t neighbour_skip_ = 0;
  Keys keys_;
};

}  // namespace fiber
