#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "benchmark/peers/makers.hpp"
#include "benchmark/peers/peer_engine.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/hierarchy/segment_boxes.hpp"

namespace fiber {
namespace {

btDbvtVolume to_volume(const Aabb& box) {
  return btDbvtVolume::FromMM({box.lower[0], box.lower[1], box.lower[2]},
                              {box.upper[0], box.upper[1], box.upper[2]});
}

std::uint32_t first_point(const btDbvtNode* leaf) {
  return *static_cast<const std::uint32_t*>(leaf->data);
}

/// Offers what the tree finds.
struct Offer final : btDbvt::ICollide {
  explicit Offer(PairCollector& pairs) : collector(pairs) {}

  using ICollide::Process;
  void Process(const btDbvtNode* a, const btDbvtNode* b) override {
    collector.offer(first_point(a), first_point(b));
  }

  PairCollector& collector;
};

/// Bullet's btDbvt, the tree of its broad phase and of its soft bodies, with a leaf per segment.
/// Every leaf moves in every frame, so every one is taken out and inserted again: below the node
/// one level up, where that takes a third less time than from the root and serves as well.
class BulletEngine final : public PeerEngine {
 public:
  explicit BulletEngine(const BenchEngineOptions& options)
      : PeerEngine(options), boxes_(options.margin) {}

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    boxes_.update(fibers, same_topology);
    if (!same_topology) {
      build();
      return;
    }
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      btDbvtVolume volume = to_volume(boxes_[i]);
      tree_.update(leaves_[i], volume);
    }
  }

  void collide(const FiberAssembly& fibers, const QueryOptions& options,
               QueryResult& result) const override {
    PairCollector collector(fibers, options, result);
    Offer offer(collector);
    tree_.collideTT(tree_.m_root, tree_.m_root, offer);
    collector.finish();
  }

 private:
  void build() {
    tree_.clear();
    leaves_.clear();
    points_ = boxes_.points();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      leaves_.push_back(tree_.insert(to_volume(boxes_[i]), &points_[i]));
    }
    tree_.optimizeTopDown();
    tree_.m_lkhd = 1;  // levels to go up from a leaf before it is inserted again
  }

  SegmentBoxes boxes_;
  std::vector<std::uint32_t> points_;  // the leaves point here
  std::vector<btDbvtNode*> leaves_;
  mutable btDbvt tree_;  // collideTT changes nothing, yet is not const
};

}  // namespace

std::unique_ptr<ProximityEngine> make_bullet(const BenchEngineOptions& options) {
  return std::make_unique<BulletEngine>(options);
}

}  // namespace fiber
