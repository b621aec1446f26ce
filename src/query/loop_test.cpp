#include "fiber_proximity/query/for_engines/loop_test.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>

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

/// Whether one of these points of a fibre is further from the place than the limit [m]. As many
/// points are left out each time as it takes at least to get there, or as are in a box that is not
/// further: a fibre may stay near one place for a million points.
bool LoopTest::leaves(const LoopPlace& place, PointRange points_asked, double limit,
                      std::uint64_t& loop_steps) const {
  const LoopReach reach(place, limit);
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
                         return leaves(x, between, limit, loop_steps) ||
                                leaves(y, between, limit, loop_steps);
                       });
}

bool LoopTest::are_joined_by_graph(PointPair pair) const {
  return graph_->are_joined(fibers_->segment_id(pair.a).fiber, fibers_->segment_id(pair.b).fiber);
}

/// The points that are within the limits of questions that the rule asks.
class LoopTest::Within {
 public:
  Within(const LoopTest& test, std::uint64_t& loop_steps) : test_(test), loop_steps_(loop_steps) {}

  void clear() { count_ = 0; }
  void add(const LoopPlace& x, const LoopPlace& y, double limit) {
    questions_[count_++] = {x, y, limit};
  }

  bool at(std::uint32_t point) const {
    const Vector3d& place = test_.fibers_->points()[point];
    ++loop_steps_;
    return !some([&](const LoopPlace& from, double limit) {
      return LoopReach(from, limit).is_beyond(place);
    });
  }

  bool along(std::uint32_t first, std::uint32_t last) const {
    return !some([&](const LoopPlace& from, double limit) {
      return test_.leaves(from, {first, last + 1}, limit, loop_steps_);
    });
  }

 private:
  struct Question {
    LoopPlace x;
    LoopPlace y;
    double limit;
  };

  template <class IsLeft>
  bool some(const IsLeft& is_left) const {
    return std::any_of(questions_.begin(), questions_.begin() + count_, [&](const Question& asked) {
      return is_left(asked.x, asked.limit) || is_left(asked.y, asked.limit);
    });
  }

  const LoopTest& test_;
  std::uint64_t& loop_steps_;
  std::array<Question, loop_question_count> questions_;
  std::ptrdiff_t count_ = 0;
};

/// Whether each way through joints makes a loop. A way makes none if it is within the limits of all
/// questions that the rule asks of those with its outer ends.
bool LoopTest::all_ways_make_loops(PointPair pair, const SegmentDistance& nearest,
                                   std::uint64_t& loop_steps) const {
  const Capsule a = fibers_->capsule(pair.a);
  const Capsule b = fibers_->capsule(pair.b);
  const SegmentWays ways(*graph_, pair);
  Within within(*this, loop_steps);
  // The one about the nearest places is the same for all ways.
  within.add(place_on(a, nearest.s), place_on(b, nearest.t), LoopLimit(a, b)(nearest.distance));
  if (!ways.is_passable(WayEnds(), within)) {
    return true;
  }
  for (const bool leaves_by_last : {true, false}) {
    for (const bool arrives_by_last : {false, true}) {
      within.clear();
      makes_loop_by(a, b, nearest,
                    [&](int question, const LoopPlace& x, const LoopPlace& y, double limit) {
                      if (question > 0) {  // that one would only spare the others
                        within.add(x, y, limit);
                      }
                      return question == 0;
                    },
                    {!leaves_by_last, !arrives_by_last});
      if (ways.is_passable({!leaves_by_last, leaves_by_last, !arrives_by_last, arrives_by_last},
                           within)) {
        return false;
      }
    }
  }
  return true;
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
