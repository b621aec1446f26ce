#pragma once

#include "benchmark/peers/peer.hpp"

namespace fiber {

/// Another library's broad phase as an engine. It makes boxes in its update and hence must know by
/// then how far apart a pair may be.
class PeerEngine : public ProximityEngine {
 protected:
  explicit PeerEngine(const BenchEngineOptions& options) : margin_(options.margin) {}

  /// [m] The largest a query may ask for.
  double margin() const { return margin_; }

  /// Offers every pair whose boxes overlap to a collector; there are at least two segments.
  virtual void collide(const FiberAssembly& fibers, const QueryOptions& options,
                       QueryResult& result) const = 0;

 private:
  /// @throws std::invalid_argument for other types than ALL, and margins beyond the one it is for
  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const final;

  /// @throws std::invalid_argument always
  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const final;

  double margin_;
};

}  // namespace fiber
