#include "fiber_proximity/hierarchy/run_tree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "fiber_proximity/hierarchy/space_curve.hpp"

namespace fiber {
namespace {

// Below this many groups one thread is faster than waking others.
constexpr std::uint32_t groups_per_job = 64;

std::uint32_t divided_up(std::uint32_t count) { return (count + run_width - 1) / run_width; }

/// Cuts every fibre into the fewest runs, of about equal length.
std::vector<RunSpan> cut_into_runs(const std::vector<std::uint32_t>& offsets) {
  std::vector<RunSpan> spans;
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    const std::uint32_t segments = offsets[fiber + 1] - offsets[fiber] - 1;
    const std::uint32_t runs = divided_up(segments);
    for (std::uint32_t run = 0; run < runs; ++run) {
      const auto begin = static_cast<std::uint32_t>(std::uint64_t{segments} * run / runs);
      const auto end = static_cast<std::uint32_t>(std::uint64_t{segments} * (run + 1) / runs);
      spans.push_back({offsets[fiber] + begin, end - begin});
    }
  }
  return spans;
}

/// Calls for parts of [0, count), on several threads if there is enough to do.
template <class Call>
void for_ranges(std::uint32_t count, const Call& call) {
  if (count <= groups_per_job) {
    call(0, count);
    return;
  }
  tbb::parallel_for(
      tbb::blocked_range<std::uint32_t>(0, count, groups_per_job),
      [&](const tbb::blocked_range<std::uint32_t>& range) { call(range.begin(), range.end()); });
}

double half_area(const float (&lower)[3], const float (&upper)[3]) {
  const double x = static_cast<double>(upper[0]) - static_cast<double>(lower[0]);
  const double y = static_cast<double>(upper[1]) - static_cast<double>(lower[1]);
  const double z = static_cast<double>(upper[2]) - static_cast<double>(lower[2]);
  return x * y + y * z + z * x;
}

/// The box of one child.
void child_box(const BoxBlock& block, std::uint32_t lane, float (&lower)[3], float (&upper)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = block.lower[axis][lane];
    upper[axis] = block.upper[axis][lane];
  }
}

/// The box of a whole block; lanes without a child repeat the last.
void block_box(const BoxBlock& block, float (&lower)[3], float (&upper)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = *std::min_element(block.lower[axis], block.lower[axis] + run_width);
    upper[axis] = *std::max_element(block.upper[axis], block.upper[axis] + run_width);
  }
}

}  // namespace

void RunTree::build(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
  origin_ = origin;
  spans_ = cut_into_runs(fibers.offsets());
  runs_.resize(spans_.size());
  segment_boxes_.resize(spans_.size());
  levels_.clear();
  for (std::uint32_t count = run_count(); count > 0 && (levels_.empty() || count > 1);) {
    count = divided_up(count);
    levels_.push_back({std::vector<BoxBlock>(count), std::vector<CapsuleBlock>(count)});
  }
  set_view();
  sort(fibers);
  sort_count_ = 0;
}

void RunTree::update(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
  origin_ = origin;
  refit(fibers);
  if (looseness() > most_decay * sorted_looseness_) {
    sort(fibers);
    ++sort_count_;
  }
}

void RunTree::sort(const FiberAssembly& fibers) {
  const SpaceCurve curve(fibers.points());
  places_.resize(spans_.size());
  for_ranges(run_count(), [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t run = begin; run < end; ++run) {
      const RunSpan& span = spans_[run];
      places_[run] = {curve.key(0.5 * fibers.points()[span.first_point] +
                                0.5 * fibers.points()[span.first_point + span.segment_count]),
                      span};
    }
  });
  tbb::parallel_sort(places_.begin(), places_.end(), [](const Place& x, const Place& y) {
    return x.key != y.key ? x.key < y.key : x.span.first_point < y.span.first_point;
  });
  for (std::uint32_t run = 0; run < run_count(); ++run) {
    spans_[run] = places_[run].span;
  }
  refit(fibers);
  sorted_looseness_ = looseness();
}

void RunTree::refit(const FiberAssembly& fibers) {
  if (levels_.empty()) {
    return;
  }
  Level& groups = levels_.front();
  for_ranges(static_cast<std::uint32_t>(groups.boxes.size()),
             [&](std::uint32_t begin, std::uint32_t end) {
               fit_groups(fibers, origin_, spans_.data(), run_count(), begin, end, runs_.data(),
                          segment_boxes_.data(), groups.capsules.data(), groups.boxes.data());
             });
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    const Level& below = levels_[i - 1];
    Level& level = levels_[i];
    for_ranges(static_cast<std::uint32_t>(level.boxes.size()),
               [&](std::uint32_t begin, std::uint32_t end) {
                 fit_nodes(below.boxes.data(), below.capsules.data(),
                           static_cast<std::uint32_t>(below.boxes.size()), begin, end,
                           level.boxes.data(), level.capsules.data());
               });
  }
}

/// Area of the groups' boxes per area of their runs' boxes: what sorting keeps small. Judged by
/// some groups, evenly spread.
double RunTree::looseness() const {
  if (levels_.empty()) {
    return 0.0;
  }
  constexpr std::size_t sample = 1024;
  const std::vector<BoxBlock>& groups = levels_.front().boxes;
  double of_runs = 0.0;
  double of_groups = 0.0;
  for (std::size_t group = 0; group < groups.size(); group += groups.size() / sample + 1) {
    float lower[3];
    float upper[3];
    for (std::uint32_t lane = 0; lane < run_width; ++lane) {
      child_box(groups[group], lane, lower, upper);
      of_runs += half_area(lower, upper);
    }
    block_box(groups[group], lower, upper);
    of_groups += half_area(lower, upper);
  }
  return of_runs > 0.0 ? of_groups / of_runs : 0.0;
}

void RunTree::set_view() {
  view_ = {};
  view_.runs = runs_.data();
  view_.spans = spans_.data();
  view_.segment_boxes = segment_boxes_.data();
  view_.level_count = static_cast<std::uint32_t>(levels_.size());
  std::uint32_t children = run_count();
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const auto nodes = static_cast<std::uint32_t>(levels_[level].boxes.size());
    view_.levels[level] = {levels_[level].boxes.data(), levels_[level].capsules.data(), nodes,
                           children};
    children = nodes;
  }
}

std::size_t RunTree::memory_bytes() const {
  std::size_t bytes = spans_.capacity() * sizeof(RunSpan) + runs_.capacity() * sizeof(Run) +
                      segment_boxes_.capacity() * sizeof(BoxBlock) +
                      places_.capacity() * sizeof(Place);
  for (const Level& level : levels_) {
    bytes += level.boxes.capacity() * sizeof(BoxBlock) +
             level.capsules.capacity() * sizeof(CapsuleBlock);
  }
  return bytes;
}

}  // namespace fiber
