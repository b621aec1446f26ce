#define CGAL_LINKED_WITH_TBB  // for Parallel_tag
#include <CGAL/box_intersection_d.h>

#include "benchmark/peers/makers.hpp"
#include "benchmark/peers/parallel_collector.hpp"
#include "benchmark/peers/peer_engine.hpp"
#include "benchmark/peers/peer_threads.hpp"
#include "src/hierarchy/segment_boxes.hpp"

namespace fiber {
namespace {

/// A box as CGAL takes it.
struct CgalBox {
  using NT = float;
  using ID = std::uint32_t;

  float lower[3];
  float upper[3];
  std::uint32_t point;  // the segment's first

  static int dimension() { return 3; }
  NT min_coord(int axis) const { return lower[axis]; }
  NT max_coord(int axis) const { return upper[axis]; }
  ID id() const { return point; }
};

/// CGAL::box_self_intersection_d: segment trees made anew in every query.
class CgalEngine final : public PeerEngine {
 public:
  explicit CgalEngine(const BenchEngineOptions& options)
      : PeerEngine(options), threads_(options.threads), boxes_(options.margin) {}

  EngineFacts facts() const override { return {threads_.count()}; }

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    threads_.update(boxes_, fibers, same_topology);
    cgal_boxes_.resize(boxes_.size());
    threads_.for_ranges(boxes_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Aabb& box = boxes_[i];
        cgal_boxes_[i] = {{box.lower[0], box.lower[1], box.lower[2]},
                          {box.upper[0], box.upper[1], box.upper[2]},
                          boxes_.points()[i]};
      }
    });
  }

  void collide(const FiberAssembly& fibers, const QueryOptions& options,
               QueryResult& result) const override {
    threads_.run([&] {
      collector_.collect(fibers, options, result, [&](ParallelCollector& collector) {
        if (threads_.count() == 1) {
          self_intersection<CGAL::Sequential_tag>(collector);
        } else {
          self_intersection<CGAL::Parallel_tag>(collector);
        }
      });
    });
  }

 private:
  /// Below this many boxes CGAL sweeps them. Its default, 10, is slow here.
  static constexpr std::ptrdiff_t cutoff = 1000;

  template <class Concurrency>
  void self_intersection(ParallelCollector& collector) const {
    CGAL::box_self_intersection_d<Concurrency>(
        cgal_boxes_.begin(), cgal_boxes_.end(),
        [&](const CgalBox& a, const CgalBox& b) { collector.local().offer(a.point, b.point); },
        cutoff);
  }

  PeerThreads threads_;
  SegmentBoxes boxes_;
  mutable std::vector<CgalBox> cgal_boxes_;  // every query reorders them
  mutable ParallelCollector collector_;
};

}  // namespace

std::unique_ptr<ProximityEngine> make_cgal(const BenchEngineOptions& options) {
  return std::make_unique<CgalEngine>(options);
}

}  // namespace fiber
