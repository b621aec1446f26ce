#include "src/mpi/box_tree.hpp"

#include <limits>
#include <numeric>

namespace fiber {
namespace {

constexpr float max_float = std::numeric_limits<float>::max();

// Outward margin of a bound: more than it is rounded by when it is taken from the origin and when
// it becomes a float.
float outward_margin(float bound) {
  return 0x1p-22F * std::abs(bound) + std::numeric_limits<float>::min();
}

double centre(const Box3d& box, std::size_t axis) {
  return 0.5 * box.min()[axis] + 0.5 * box.max()[axis];
}

std::size_t longest_axis(const std::vector<Box3d>& boxes, const std::uint32_t* begin,
                         const std::uint32_t* end) {
  Box3d all = boxes[*begin];
  for (const std::uint32_t* number = begin; number != end; ++number) {
    all.extend(boxes[*number]);
  }
  Eigen::Index longest = 0;
  all.sizes().maxCoeff(&longest);
  return static_cast<std::size_t>(longest);
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const std::vector<Box3d>& boxes) {
  std::vector<std::uint32_t> numbers(boxes.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  struct Range {
    std::size_t begin;
    std::size_t end;
  };
  std::vector<Range> waiting{{0, boxes.size()}};
  while (!waiting.empty()) {
    const Range range = waiting.back();
    waiting.pop_back();
    const std::size_t count = range.end - range.begin;
    if (count <= fan) {
      continue;
    }
    // Halves that are whole nodes of the tree, the largest ones there are.
    std::size_t node = 1;
    while (fan * node < count) {
      node *= fan;
    }
    const std::size_t nodes = (count + node - 1) / node;
    const std::size_t middle = range.begin + nodes / 2 * node;
    std::uint32_t* const data = numbers.data();
    const std::size_t axis = longest_axis(boxes, data + range.begin, data + range.end);
    std::nth_element(data + range.begin, data + middle, data + range.end,
                     [&](std::uint32_t x, std::uint32_t y) {
                       return centre(boxes[x], axis) < centre(boxes[y], axis);
                     });
    waiting.push_back({range.begin, middle});
    waiting.push_back({middle, range.end});
  }
  return numbers;
}

BoxTree::BoxTree(std::size_t count, const Box3d& around) : boxes_(count) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Boxes that single precision cannot tell apart are around everything.
    const double middle = centre(around, axis);
    origin_[axis] = std::isfinite(middle) ? middle : 0.0;
  }
  std::size_t begin = 0;
  while (count > 1) {
    count = (count + fan - 1) / fan;
    begins_.push_back(begin);
    begin += count;
  }
  nodes_.resize(begin);
}

BoxTree::BoxTree(const std::vector<Box3d>& boxes) : BoxTree(boxes.size(), union_of(boxes)) {
  for (std::uint32_t place = 0; place < boxes.size(); ++place) {
    put(place, boxes[place]);
  }
  close();
}

BoxTree::Box BoxTree::seen_from_origin(const Box3d& box) const {
  Box seen;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto lower = static_cast<float>(box.min()[axis] - origin_[axis]);
    const auto upper = static_cast<float>(box.max()[axis] - origin_[axis]);
    seen.lower[axis] =
        std::min(lower, max_float) - outward_margin(lower);  // what overflows is on the safe side
    seen.upper[axis] = std::max(upper, -max_float) + outward_margin(upper);
  }
  return seen;
}

Box3d BoxTree::absolute(const Box& box) const {
  Box3d all;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    all.min()[axis] = origin_[axis] + double{box.lower[axis]};
    all.max()[axis] = origin_[axis] + double{box.upper[axis]};
  }
  return all;
}

void BoxTree::close() {
  for (std::size_t level = 1; level <= height(); ++level) {
    const std::size_t below = count_at(level - 1);
    for (std::size_t i = 0; i < count_at(level); ++i) {
      Box all = node(level - 1, fan * i);
      for (std::size_t child = fan * i + 1; child < std::min(fan * i + fan, below); ++child) {
        all = all.merged(node(level - 1, child));
      }
      nodes_[begins_[level - 1] + i] = all;
    }
  }
}

std::vector<Box3d> BoxTree::level_of_at_most(std::size_t count) const {
  std::size_t level = 0;
  while (count_at(level) > count) {
    ++level;
  }
  std::vector<Box3d> boxes;
  for (std::size_t i = 0; i < count_at(level); ++i) {
    boxes.push_back(absolute(node(level, i)));
  }
  return boxes;
}

/// Appends those of the visit's list that meet the box.
void BoxTree::append_meeting(const Box& box, const Visit& visit,
                             std::vector<std::uint32_t>& places) const {
  places.resize(visit.end + (visit.end - visit.begin));
  std::size_t end = visit.end;
  for (std::size_t i = visit.begin; i < visit.end; ++i) {
    places[end] = places[i];  // without a branch
    end += node(visit.level_of_others, places[i]).intersects(box) ? 1 : 0;
  }
  places.resize(end);
}

/// Appends the children that meet the box.
/// @param level of the nodes whose places are in the list from `begin` on
void BoxTree::append_children(const Box& box, std::size_t level, std::size_t begin,
                              std::vector<std::uint32_t>& places) const {
  const std::size_t parents_end = places.size();
  places.resize(parents_end + fan * (parents_end - begin));
  const std::size_t count = count_at(level - 1);
  std::size_t end = parents_end;
  for (std::size_t i = begin; i < parents_end; ++i) {
    const std::size_t first = fan * std::size_t{places[i]};
    for (std::size_t child = first; child < std::min(first + fan, count); ++child) {
      places[end] = static_cast<std::uint32_t>(child);
      end += node(level - 1, child).intersects(box) ? 1 : 0;
    }
  }
  places.resize(end);
}

}  // namespace fiber
