#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <stdexcept>
#include <type_traits>

#include "benchmark/peers/makers.hpp"
#include "benchmark/peers/parallel_collector.hpp"
#include "benchmark/peers/peer_engine.hpp"
#include "benchmark/peers/peer_threads.hpp"
#include "src/hierarchy/segment_boxes.hpp"

namespace fiber {
namespace {

/// Embree's handles, released when they go.
struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owner = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

void get_bounds(const RTCBoundsFunctionArguments* arguments) {
  const Aabb& box =
      (*static_cast<const SegmentBoxes*>(arguments->geometryUserPtr))[arguments->primID];
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = box.lower[0];
  bounds.lower_y = box.lower[1];
  bounds.lower_z = box.lower[2];
  bounds.upper_x = box.upper[0];
  bounds.upper_y = box.upper[1];
  bounds.upper_z = box.upper[2];
}

/// The data of rtcCollide's callback.
struct Collision {
  const SegmentBoxes& boxes;
  ParallelCollector& collector;
};

/// Embree reports every pair in both orders, and all pairs of two leaves that overlap without a
/// look at the boxes in them.
void offer_pairs(void* user, RTCCollision* pairs, unsigned int count) {
  const auto& [boxes, parallel_collector] = *static_cast<const Collision*>(user);
  ParallelCollector::Part& collector = parallel_collector.local();
  for (const RTCCollision* pair = pairs; pair != pairs + count; ++pair) {
    if (pair->primID0 < pair->primID1 &&
        overlaps(boxes[pair->primID0], boxes[pair->primID1], 0.0F)) {
      collector.offer(boxes.points()[pair->primID0], boxes.points()[pair->primID1]);
    }
  }
}

/// Embree's tree over user geometry, the boxes of the segments, and its rtcCollide.
class EmbreeEngine final : public PeerEngine {
 public:
  EmbreeEngine(const BenchEngineOptions& options, RTCBuildQuality quality)
      : PeerEngine(options),
        quality_(quality),
        threads_(options.threads),
        boxes_(options.margin),
        device_(rtcNewDevice(("threads=" + std::to_string(threads_.count())).c_str())) {
    check();
  }

  EngineFacts facts() const override { return {threads_.count()}; }

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override {
    threads_.update(boxes_, fibers, same_topology);
    if (!same_topology) {
      make_scene();
    }
    threads_.run([this] {
      // User geometry has no buffer: any one says that it has changed.
      rtcUpdateGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry_.get());
      rtcCommitScene(scene_.get());
    });
    check();
  }

  void collide(const FiberAssembly& fibers, const QueryOptions& options,
               QueryResult& result) const override {
    threads_.run([&] {
      collector_.collect(fibers, options, result, [&](ParallelCollector& collector) {
        Collision collision{boxes_, collector};
        rtcCollide(scene_.get(), scene_.get(), offer_pairs, &collision);
      });
    });
    check();
  }

 private:
  void make_scene() {
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC);
    // Only a scene of low quality heeds the quality of its geometries, a refit among them.
    rtcSetSceneBuildQuality(scene_.get(), quality_ == RTC_BUILD_QUALITY_MEDIUM
                                              ? RTC_BUILD_QUALITY_MEDIUM
                                              : RTC_BUILD_QUALITY_LOW);
    geometry_.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryBuildQuality(geometry_.get(), quality_);
    rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned int>(boxes_.size()));
    rtcSetGeometryUserData(geometry_.get(), &boxes_);
    rtcSetGeometryBoundsFunction(geometry_.get(), get_bounds, nullptr);
    rtcAttachGeometry(scene_.get(), geometry_.get());
  }

  /// @throws std::runtime_error if Embree has had an error
  void check() const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE) {
      throw std::runtime_error("Embree's error " + std::to_string(error));
    }
  }

  RTCBuildQuality quality_;
  PeerThreads threads_;
  SegmentBoxes boxes_;
  Owner<RTCDevice> device_;
  Owner<RTCScene> scene_;
  Owner<RTCGeometry> geometry_;
  mutable ParallelCollector collector_;
};

template <RTCBuildQuality quality>
std::unique_ptr<ProximityEngine> make(const BenchEngineOptions& options) {
  return std::make_unique<EmbreeEngine>(options, quality);
}

}  // namespace

std::unique_ptr<ProximityEngine> make_embree_low(const BenchEngineOptions& options) {
  return make<RTC_BUILD_QUALITY_LOW>(options);
}

std::unique_ptr<ProximityEngine> make_embree_medium(const BenchEngineOptions& options) {
  return make<RTC_BUILD_QUALITY_MEDIUM>(options);
}

std::unique_ptr<ProximityEngine> make_embree_refit(const BenchEngineOptions& options) {
  return make<RTC_BUILD_QUALITY_REFIT>(options);
}

}  // namespace fiber
