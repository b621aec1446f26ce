#include "src/hierarchy/run_tree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/sort_keys.hpp"
#include "src/hierarchy/space_curve.hpp"

namespace fiber {
namespace {

// Below this many groups one thread is faster than waking others.
constexpr std::uint32_t groups_per_job = 64;

std::uint32_t divided_up(std::uint32_t count) { return (count + run_width - 1) / run_width; }

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

/// First points of all segments, fibre by fibre.
/// @param first_points at least as many as there are segments
void number_segments(const std::vector<std::uint32_t>& offsets,
                     std::vector<std::uint32_t>& first_points) {
  for_ranges(
      static_cast<std::uint32_t>(offsets.size() - 1), [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t fiber = begin; fiber < end; ++fiber) {
          // Every fibre before it has one point more than segments.
          const auto first = first_points.begin() + (offsets[fiber] - fiber);
          std::iota(first, first + (offsets[fiber + 1] - offsets[fiber] - 1), offsets[fiber]);
        }
      });
}

double half_area(const float (&lower)[3], const float (&upper)[3]) {
  const double x = static_cast<double>(upper[0]) - static_cast<double>(lower[0]);
  const double y = static_cast<double>(upper[1]) - static_cast<double>(lower[1]);
  const double z = static_cast<double>(upper[2]) - static_cast<double>(lower[2]);
  return x * y + y * z + z * x;
}

/// Half the area of the box of a segment, as a run holds it [m²].
double half_area(const Run& run, std::uint32_t lane) {
  float lower[3];
  float upper[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float radius = run.radius[lane];
    lower[axis] = std::min(run.start[axis][lane], run.end[axis][lane]) - radius;
    upper[axis] = std::max(run.start[axis][lane], run.end[axis][lane]) + radius;
  }
  return half_area(lower, upper);
}

/// Half of the surface of one child's box.
double half_area(const BoxBlock& block, std::uint32_t lane) {
  const float lower[3] = {block.lower[0][lane], block.lower[1][lane], block.lower[2][lane]};
  const float upper[3] = {block.upper[0][lane], block.upper[1][lane], block.upper[2][lane]};
  return half_area(lower, upper);
}

}  // namespace

void RunTree::build(const TreeFibers& fibers) {
  std::vector<std::uint32_t> first_points(fibers.before.segment_count());
  number_segments(fibers.before.offsets(), first_points);
  build(fibers, first_points);
}

void RunTree::build(const TreeFibers& fibers, const std::vector<std::uint32_t>& first_points) {
  first_points_ = first_points;
  segment_count_ = static_cast<std::uint32_t>(first_points_.size());
  runs_.resize(divided_up(segment_count_));
  first_points_.resize(runs_.size() * run_width);
  std::size_t level_count = 0;
  for (auto count = static_cast<std::uint32_t>(runs_.size());
       count > 0 && (level_count == 0 || count > 1); ++level_count) {
    count = divided_up(count);
    levels_.resize(std::max(levels_.size(), level_count + 1));
    levels_[level_count].resize(count);
  }
  levels_.resize(level_count);
  min_points_.resize(level_count);
  for (std::size_t level = 0; level < level_count; ++level) {
    min_points_[level].resize(levels_[level].size() * run_width);
  }
  set_view();
  origin_ = fibers.origin_before;
  sort(fibers.before);
  refit(fibers);
  sort_count_ = 0;
}

void RunTree::update(const TreeFibers& fibers) {
  assert(segment_count_ == fibers.before.segment_count());
  origin_ = fibers.origin_before;
  if (looseness(fibers.before) > max_decay * sorted_looseness_) {
    // Read along the fibres, points are near each other in memory: along a curve that has decayed,
    // they are near in nothing.
    number_segments(fibers.before.offsets(), first_points_);
    sort(fibers.before);
    ++sort_count_;
  }
  refit(fibers);
}

void RunTree::sort(const FiberAssembly& fibers) {
  const SpaceCurve curve(fibers.points());
  keys_.resize(segment_count_);
  for_ranges(segment_count_, [&](std::uint32_t begin, std::uint32_t end) {
    curve.key_segments(fibers.points(), first_points_.data() + begin, end - begin,
                       keys_.data() + begin);
  });
  sort_keys(keys_, scratch_);
  for_ranges(segment_count_, [&](std::uint32_t begin, std::uint32_t end) {
    std::transform(keys_.begin() + begin, keys_.begin() + end, first_points_.begin() + begin,
                   [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
  });
  if (segment_count_ > 0) {
    std::fill(first_points_.begin() + segment_count_, first_points_.end(),
              first_points_[segment_count_ - 1]);
  }
  find_min_points();
  sorted_looseness_ = looseness(fibers);
}

/// The least points follow the order of the curve: they stay while boxes are refitted.
void RunTree::find_min_points() {
  const std::vector<std::uint32_t>* below = &first_points_;
  for (std::vector<std::uint32_t>& level : min_points_) {
    const auto children = static_cast<std::uint32_t>(below->size() / run_width);
    for_ranges(children, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t child = begin; child < end; ++child) {
        const auto first = below->begin() + std::ptrdiff_t{child} * run_width;
        level[child] = *std::min_element(first, first + run_width);
      }
    });
    std::fill(level.begin() + children, level.end(), std::numeric_limits<std::uint32_t>::max());
    below = &level;
  }
}

void RunTree::refit(const TreeFibers& fibers) {
  origin_after_ = fibers.origin_after;
  if (fibers.moves) {
    displacements_.resize(runs_.size());
  }
  view_.displacements = fibers.moves ? displacements_.data() : nullptr;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    std::vector<BoxBlock>& boxes = levels_[i];
    for_ranges(
        static_cast<std::uint32_t>(boxes.size()), [&](std::uint32_t begin, std::uint32_t end) {
          if (i == 0) {
            fit_groups(fibers, first_points_.data(), segment_count_, begin, end, runs_.data(),
                       displacements_.data(), boxes.data());
          } else {
            fit_nodes(levels_[i - 1].data(), static_cast<std::uint32_t>(levels_[i - 1].size()),
                      begin, end, boxes.data());
          }
        });
  }
}

/// Area of the runs' boxes per area of their segments' boxes: what sorting keeps small. Judged by
/// some groups, evenly spread, which it fits; where segments are, not where they move.
double RunTree::looseness(const FiberAssembly& fibers) {
  constexpr std::size_t sample = 32;
  double of_segments = 0.0;
  double of_runs = 0.0;
  const std::size_t groups = levels_.empty() ? 0 : levels_.front().size();
  for (std::size_t group = 0; group < groups; group += groups / sample + 1) {
    const auto begin = static_cast<std::uint32_t>(group);
    fit_groups({fibers, origin_}, first_points_.data(), segment_count_, begin, begin + 1,
               runs_.data(), nullptr, levels_.front().data());
    const std::size_t first_run = group * run_width;
    const std::size_t run_count = std::min<std::size_t>(run_width, runs_.size() - first_run);
    for (std::uint32_t run = 0; run < run_count; ++run) {
      for (std::uint32_t lane = 0; lane < run_width; ++lane) {
        of_segments += half_area(runs_[first_run + run], lane);
      }
      of_runs += half_area(levels_.front()[group], run);
    }
  }
  return of_segments > 0.0 ? of_runs / of_segments : 0.0;
}

void RunTree::set_view() {
  view_ = {};
  view_.runs = runs_.data();
  view_.first_points = first_points_.data();
  view_.segment_count = segment_count_;
  view_.level_count = static_cast<std::uint32_t>(levels_.size());
  auto children = static_cast<std::uint32_t>(runs_.size());
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const auto nodes = static_cast<std::uint32_t>(levels_[level].size());
    view_.levels[level] = {levels_[level].data(), nodes, children, min_points_[level].data()};
    children = nodes;
  }
}

bool RunTree::is_unbounded() const {
  if (levels_.empty()) {
    return false;
  }
  const BoxBlock& boxes = levels_.back().front();
  return std::any_of(boxes.upper[0], boxes.upper[0] + run_width,
                     [](float upper) { return !(upper < std::numeric_limits<float>::infinity()); });
}

std::size_t RunTree::memory_bytes() const {
  std::size_t bytes = first_points_.capacity() * sizeof(std::uint32_t) +
                      runs_.capacity() * sizeof(Run) +
                      displacements_.capacity() * sizeof(RunDisplacement) +
                      (keys_.capacity() + scratch_.capacity()) * sizeof(std::uint64_t);
  for (const std::vector<BoxBlock>& boxes : levels_) {
    bytes += boxes.capacity() * sizeof(BoxBlock);
  }
  for (const std::vector<std::uint32_t>& points : min_points_) {
    bytes += points.capacity() * sizeof(std::uint32_t);
  }
  return bytes;
}

std::uint32_t nearest_run(const RunTreeView& tree, const BoxBlock& boxes) {
  std::uint32_t nearest = 0;
  for (std::uint32_t level = tree.level_count; level-- > 0;) {
    const RunTreeLevel& nodes = tree.levels[level];
    const BoxBlock& children = nodes.boxes[nearest];
    const std::uint32_t first = nearest * run_width;
    float least = std::numeric_limits<float>::infinity();
    nearest = first;
    for (std::uint32_t lane = 0; lane < std::min(run_width, nodes.child_count - first); ++lane) {
      float squared = 0.0F;
      for (int axis = 0; axis < 3; ++axis) {
        const float gap = std::max({children.lower[axis][lane] - boxes.upper[axis][0],
                                    boxes.lower[axis][0] - children.upper[axis][lane], 0.0F});
        squared += gap * gap;
      }
      if (squared < least) {
        least = squared;
        nearest = first + lane;
      }
    }
  }
  return nearest;
}

}  // namespace fiber
