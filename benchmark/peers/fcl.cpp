#include "benchmark/peers/makers.hpp"
#include "benchmark/peers/peer_engine.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/compare/fcl_broad_phase.hpp"

namespace fiber {
namespace {

/// FCL's dynamic AABB tree as an engine.
class FclEngine final : public PeerEngine {
 public:
  FclEngine(const BenchEngineOptions& options, std::unique_ptr<FclBroadPhase> broad_phase)
      : PeerEngine(options), broad_phase_(std::move(broad_phase)) {}

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    broad_phase_->update(fibers, same_topology);
  }

  void collide(const FiberAssembly& fibers, const QueryOptions& options,
               QueryResult& result) const override {
    PairCollector collector(fibers, options, result);
    broad_phase_->collide(collector);
    collector.finish();
  }

 private:
  std::unique_ptr<FclBroadPhase> broad_phase_;
};

}  // namespace

std::unique_ptr<ProximityEngine> make_fcl(const BenchEngineOptions& options) {
  return std::make_unique<FclEngine>(options, make_fcl_boxes(options.margin));
}

std::unique_ptr<ProximityEngine> make_fcl_naive(const BenchEngineOptions& options) {
  return std::make_unique<FclEngine>(options, make_fcl_capsules(options.margin));
}

}  // namespace fiber
