#include "benchmark/peers/peer_engine.hpp"

#include <stdexcept>

namespace fiber {

void PeerEngine::do_query(const FiberAssembly& fibers, const QueryOptions& options,
                          QueryResult& result) const {
  if (options.type != QueryType::ALL) {
    throw std::invalid_argument("query type: a peer answers only ALL");
  }
  if (options.margin > margin_) {
    throw std::invalid_argument("margin is " + std::to_string(options.margin) +
                                " m, this peer's boxes are made for at most " +
                                std::to_string(margin_) + " m");
  }
  if (fibers.segment_count() > 1) {
    collide(fibers, options, result);
  }
}

void PeerEngine::do_query_shape(const FiberAssembly& /*shape*/, const FiberAssembly& /*fibers*/,
                                const QueryOptions& /*options*/, QueryResult& /*result*/) const {
  throw std::invalid_argument("query of a shape: a peer answers only ALL of its own fibres");
}

}  // namespace fiber
