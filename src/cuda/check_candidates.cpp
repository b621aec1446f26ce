#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/query/for_engines/loop_test.hpp"
#include "src/cuda/device_proximity_tree.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

/// The number of the range that a value is in.
/// @param begins of all ranges, ascending, the first one 0
std::uint32_t range_of(const std::vector<std::uint32_t>& begins, std::uint32_t value) {
  return static_cast<std::uint32_t>(std::upper_bound(begins.begin(), begins.end(), value) -
                                    begins.begin()) -
         1;
}

/// Some of many fibres, as an assembly of their own.
struct SomeFibers {
  std::vector<std::uint32_t> offsets{0};
  std::vector<std::uint32_t> points;  // which ones they are of all

  void add(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t point = begin; point < end; ++point) {
      points.push_back(point);
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
};

/// A contact of one fibre with itself that may need a loop.
struct Question {
  PointPair pair;           // of the fibres that were added
  std::uint32_t candidate;  // it is of
};

}  // namespace

void DeviceProximity::check_candidates(const Options& options,
                                       std::vector<std::uint8_t>& touching) const {
  if (tree_->candidates.empty()) {
    throw std::logic_error("there are no candidates: DeviceProximity is made without them");
  }
  const bool needs_loops = !options.neighbour_skip;
  const PairRule rule = rule_of(options);
  std::vector<std::uint32_t> marks;
  std::vector<std::uint64_t> asked;
  device_->touching(*tree_->tree, rule, options.margin, needs_loops, marks, asked);
  touching.assign(marks.begin(), marks.end());

  // In the order of fibres, so that each is added once.
  std::sort(asked.begin(), asked.end());
  SomeFibers some;
  std::vector<double> radii;
  std::vector<Question> questions;
  std::uint32_t end = 0;    // of the fibre added last
  std::uint32_t moved = 0;  // by which numbers of its points are less among those added
  for (const std::uint64_t key : asked) {
    const auto a = static_cast<std::uint32_t>(key >> 32U);
    const auto b = static_cast<std::uint32_t>(key);
    const std::uint32_t candidate = range_of(tree_->candidate_points, a);
    if (touching[candidate] != 0) {
      continue;
    }
    if (a >= end) {
      const std::uint32_t fiber = range_of(offsets_, a);
      const std::uint32_t begin = offsets_[fiber];
      end = offsets_[fiber + 1];
      moved = begin - some.offsets.back();
      some.add(begin, end);
      radii.push_back(tree_->fibers.radii == nullptr ? tree_->fibers.radius : tree_->radii[begin]);
    }
    questions.push_back({{a - moved, b - moved}, candidate});
  }
  if (questions.empty()) {
    return;
  }
  if (tree_->radius_per == RadiusPer::POINT) {
    radii.clear();
    for (const std::uint32_t point : some.points) {
      radii.push_back(tree_->given_radii[point]);
    }
  }
  std::vector<Eigen::Vector3d> points(some.points.size());
  device_->read_points(*tree_->tree, some.points, points.front().data());
  const FiberAssembly fibers(std::move(points), std::move(some.offsets), std::move(radii));
  const LoopTest loops(fibers);
  std::vector<std::uint8_t> make_loops(questions.size());
  for_each_of(questions.size(), [&](std::size_t i) {
    const PointPair pair = questions[i].pair;
    const Capsule a = fibers.capsule(pair.a);
    const Capsule b = fibers.capsule(pair.b);
    make_loops[i] = loops.makes_loop(pair, segment_distance(a.p0, a.p1, b.p0, b.p1)) ? 1 : 0;
  });
  for (std::size_t i = 0; i < questions.size(); ++i) {
    touching[questions[i].candidate] |= make_loops[i];
  }
}

}  // namespace fiber
