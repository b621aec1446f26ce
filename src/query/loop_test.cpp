#include "fiber_proximity/query/for_engines/loop_test.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>

#include "src/geometry/fiber_graph.hpp"
#include "src/geometry/norm.hpp"
#include "src/query/loop_chain.hpp"
#include "src/query/loop_rule.hpp"
#include "src/query/segment_ways.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

// So few points are looked at one by one: that takes no longer than the distance of the pair.
constexpr std::uint32_t short_walk = 64;

double thinnest_radius(const FiberAssembly& fibers, std::uint32_t fiber) {
  double radius = fibers.largest_radius();
  for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
    radius = std::min(radius, fibers.segment_radius(i));
  }
  return radius;
}

/// [m] At least the length of every segment.
double longest_step(const FiberAssembly& fibers, std::uint32_t fiber) {
  double longest = 0.0;
  for (std::uint32_t i = fibers.offsets()[fiber] + 1; i < fibers.offsets()[fiber + 1]; ++i) {
    longest = std::max(longest, norm_of(fibers.points()[i] - fibers.points()[i - 1]));
  }
  return longest * (1.0 + 0x1p-40);
}

}  // namespace

/// Knowledge of a fibre that shortens long walks along it.
struct LoopTest::Chain {
  void fit(const FiberAssembly& fibers, std::uint32_t fiber) {
    step = longest_step(fibers, fiber);
    stretches.find(fibers, fiber, thinnest_radius(fibers, fiber));
    boxes.fit(fibers, fiber);
  }

  double step = 0.0;  // [m] no two points that follow each other are further apart
  LoopFreeStretches stretches;
  PointBoxes boxes;
};

struct LoopTest::Slot {
  std::atomic<bool> is_filled{false};
  std::unique_ptr<Chain> chain;  // may be that of fibres before these, for its memory
};

LoopTest::LoopTest() = default;

LoopTest::LoopTest(const FiberAssembly& fibers) { reset(fibers); }

LoopTest::~LoopTest() = default;

void LoopTest::reset(const FiberAssembly& fibers) {
  fibers_ = &fibers;
  graph_ = fibers.graph().get();
  if (slots_.size() != fibers.fiber_count()) {
    slots_ = std::vector<Slot>(fibers.fiber_count());
  }
  max_points_ = 0;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    max_points_ = std::max(max_points_, fibers.offsets()[fiber + 1] - fibers.offsets()[fiber]);
    slots_[fiber].is_filled.store(false, std::memory_order_relaxed);
  }
}

std::size_t LoopTest::memory_bytes() const {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = slots_.capacity() * sizeof(Slot);
  for (const Slot& slot : slots_) {
    if (slot.chain != nullptr) {
      bytes +=
          sizeof(Chain) + slot.chain->stretches.memory_bytes() + slot.chain->boxes.memory_bytes();
    }
  }
  return bytes;
}

const LoopTest::Chain& LoopTest::chain(std::uint32_t fiber) const {
  Slot& slot = slots_[fiber];
  if (!slot.is_filled.load(std::memory_order_acquire)) {
    const std::lock_guard lock(mutex_);
    if (!slot.is_filled.load(std::memory_order_relaxed)) {
      if (slot.chain == nullptr) {
        slot.chain = std::make_unique<Chain>();
      }
      slot.chain->fit(*fibers_, fiber);
      slot.is_filled.store(true, std::memory_order_release);
    }
  }
  return *slot.chain;
}

/// Whether one of these points of a fibre is beyond the reach. As many points are left out each
/// time as it takes at least to get there, or as are in a box that is not further: a fibre may stay
/// near one place for a million points.
bool LoopTest::leaves(const LoopReach& reach, PointRange points_asked,
                      std::uint64_t& loop_steps) const {
  const std::vector<Vector3d>& points = fibers_->points();
  const std::uint32_t last = points_asked.end - 1;
  const bool is_long = points_asked.end - points_asked.begin > short_walk;
  const Chain* const along =
      is_long ? &chain(fibers_->segment_id(points_asked.begin).fiber) : nullptr;
  const double step = is_long ? reach.scale() * along->step : 0.0;
  const auto is_within = [&](const Eigen::AlignedBox3d& box) { return reach.holds(box); };
  for (std::uint32_t k = points_asked.begin; k <= last; ++k) {
    ++loop_steps;
    const double squared = reach.scaled_way_to(points[k]).squaredNorm();
    if (reach.is_beyond(squared)) {
      return true;
    }
    if (is_long) {
      if (const std::uint32_t count = along->boxes.count_within(k, last, is_within)) {
        k += count - 1;
        continue;
      }
      const double rest = (1.0 - 0x1p-40) * reach.scaled_limit() - std::sqrt(squared);
      if (rest >= step * (last - k)) {
        return false;
      }
      k += rest > 0.0 ? static_cast<std::uint32_t>(rest / step) : 0;
    }
  }
  return false;
}

bool LoopTest::makes_loop(PointPair pair, const SegmentDistance& nearest,
                          std::uint64_t& loop_steps) const {
  if (graph_ == nullptr) {
    return fiber_makes_loop(pair, nearest, loop_steps);
  }
  return (!are_of_one_fiber(pair) || fiber_makes_loop(pair, nearest, loop_steps)) &&
         all_ways_make_loops(pair, nearest, loop_steps);
}

/// Whether the way along their fibre makes a loop between these segments.
bool LoopTest::fiber_makes_loop(PointPair pair, const SegmentDistance& nearest,
                                std::uint64_t& loop_steps) const {
  if (pair.b - pair.a > short_walk && rules_out(pair.a, pair.b)) {
    return false;
  }
  const PointRange between{pair.a + 1, pair.b + 1};
  return makes_loop_by(fibers_->capsule(pair.a), fibers_->capsule(pair.b), nearest,
                       [&](int /*question*/, const LoopPlace& x, const LoopPlace& y, double limit) {
                         return leaves(LoopReach(x, limit), between, loop_steps) ||
                                leaves(LoopReach(y, limit), between, loop_steps);
                       });
}

bool LoopTest::are_joined_by_graph(PointPair pair) const {
  return graph_->are_joined(fibers_->segment_id(pair.a).fiber, fibers_->segment_id(pair.b).fiber);
}

/// The points that are within the limits of some criteria of the rule.
class LoopTest::Within {
 public:
  Within(const LoopTest& test, std::uint64_t& loop_steps) : test_(test), loop_steps_(loop_steps) {}

  /// @param criterion must outlive this
  void add(const LoopCriterion& criterion) {
    for (const LoopPlace* place : {&criterion.x, &criterion.y}) {
      reaches_[count_++].emplace(*place, criterion.limit);
    }
  }
  void add(const std::optional<LoopCriterion>& criterion) {
    if (criterion) {
      add(*criterion);
    }
  }

  bool at(std::uint32_t point) const {
    const Vector3d& place = test_.fibers_->points()[point];
    ++loop_steps_;
    return all([&](const LoopReach& reach) { return !reach.is_beyond(place); });
  }

  bool along(std::uint32_t first, std::uint32_t last) const {
    if (last - first > short_walk) {
      return all([&](const LoopReach& reach) {
        return !test_.leaves(reach, {first, last + 1}, loop_steps_);
      });
    }
    for (std::uint32_t point = first; point <= last; ++point) {
      if (!at(point)) {
        return false;
      }
    }
    return true;
  }

  bool along(const WayStretch& stretch) const {
    return at(stretch.joint_point) && along(stretch.first, stretch.last);
  }

 private:
  template <class Predicate>
  bool all(const Predicate& is_held) const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (!is_held(*reaches_[i])) {
        return false;
      }
    }
    return true;
  }

  const LoopTest& test_;
  std::uint64_t& loop_steps_;
  std::array<std::optional<LoopReach>, 6> reaches_;
  std::size_t count_ = 0;
};

/// Whether each way through joints makes a loop. A way makes none if it is within the limits of all
/// criteria of the ways with its outer ends.
bool LoopTest::all_ways_make_loops(PointPair pair, const SegmentDistance& nearest,
                                   std::uint64_t& loop_steps) const {
  const SegmentWays ways(*graph_, pair);
  WayStretches from = ways.stretches_of_a();
  WayStretches to = ways.stretches_of_b();
  if (from.is_empty() || to.is_empty()) {
    return true;
  }
  const Capsule a = fibers_->capsule(pair.a);
  const Capsule b = fibers_->capsule(pair.b);
  const LoopCriteria criteria(a, b, nearest);
  const auto some_pair = [&](const auto& leads) {
    return std::any_of(from.begin(), from.end(), [&](const WayStretch& leave) {
      return std::any_of(to.begin(), to.end(),
                         [&](const WayStretch& arrive) { return leads(leave, arrive); });
    });
  };
  const LoopCriterion of_nearest = criteria.of_nearest();
  Within near(*this, loop_steps);
  near.add(of_nearest);
  // Nearly all segments are far from all joints: their joints are looked at before any way.
  for (WayStretches* stretches : {&from, &to}) {
    stretches->remove_if([&](const WayStretch& each) { return !near.at(each.joint_point); });
    if (stretches->is_empty()) {
      return true;
    }
  }
  /// The outer ends are those that the way does not come by.
  const auto are_within = [&](const WayStretch& leave, const WayStretch& arrive,
                              const auto& leads_between) {
    const auto of_end_of_a = criteria.of_end_of_a(!leave.is_by_last);
    const auto of_end_of_b = criteria.of_end_of_b(!arrive.is_by_last);
    Within within = near;
    within.add(of_end_of_a);
    within.add(of_end_of_b);
    return within.along(leave) && within.along(arrive) && leads_between(within);
  };
  // Nearly always a way that makes no loop comes by one joint only.
  if (some_pair([&](const WayStretch& leave, const WayStretch& arrive) {
        return leave.joint == arrive.joint &&
               are_within(leave, arrive, [](const Within& /*within*/) { return true; });
      })) {
    return false;
  }
  return !ways.some_leads(from, to, near) || !some_pair([&](const WayStretch& leave,
                                                            const WayStretch& arrive) {
    return leave.joint != arrive.joint && are_within(leave, arrive, [&](const Within& within) {
             return ways.some_leads(WayStretches(leave), WayStretches(arrive), within);
           });
  });
}

bool LoopTest::rules_out(std::uint32_t first, std::uint32_t last) const {
  if (last - first >= max_points_) {
    return false;
  }
  const std::uint32_t fiber = fibers_->segment_id(first).fiber;
  return is_within(fiber, last) && chain(fiber).stretches.hold(first, last + 1);
}

PointRange LoopTest::ruled_out_with(std::uint32_t point) const {
  return chain(fibers_->segment_id(point).fiber).stretches.around(point);
}

}  // namespace fiber
