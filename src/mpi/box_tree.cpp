#include "src/mpi/box_tree.hpp"

#include <numeric>
#include <utility>

namespace fiber {
namespace {

double centre(const SegmentBox& box, std::size_t axis) {
  return 0.5 * box.box.lower[axis] + 0.5 * box.box.upper[axis];
}

std::size_t longest_axis(const std::vector<SegmentBox>& boxes, const std::uint32_t* begin,
                         const std::uint32_t* end) {
  PlainBox all = boxes[*begin].box;
  for (const std::uint32_t* number = begin; number != end; ++number) {
    all = merged(all, boxes[*number].box);
  }
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (all.upper[axis] - all.lower[axis] > all.upper[longest] - all.lower[longest]) {
      longest = axis;
    }
  }
  return longest;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const std::vector<SegmentBox>& boxes) {
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

BoxTree::BoxTree(std::vector<SegmentBox> boxes) : boxes_(std::move(boxes)) {
  std::size_t begin = 0;
  for (std::size_t count = boxes_.size(); count > 1;) {
    count = (count + fan - 1) / fan;
    begins_.push_back(begin);
    begin += count;
  }
  nodes_.resize(begin);
  close();
}

void BoxTree::close() {
  for (std::size_t level = 1; level <= height(); ++level) {
    const std::size_t below = count_at(level - 1);
    for (std::size_t i = 0; i < count_at(level); ++i) {
      PlainBox all = node(level - 1, fan * i);
      for (std::size_t child = fan * i + 1; child < std::min(fan * i + fan, below); ++child) {
        all = merged(all, node(level - 1, child));
      }
      nodes_[begins_[level - 1] + i] = all;
    }
  }
}

std::vector<SegmentBox> BoxTree::level_of_at_most(std::size_t count) const {
  std::size_t level = 0;
  while (count_at(level) > count) {
    ++level;
  }
  std::vector<SegmentBox> boxes;
  for (std::size_t i = 0; i < count_at(level); ++i) {
    boxes.push_back({node(level, i), {}});
  }
  return boxes;
}

/// Appends those of the visit's list that meet the box.
void BoxTree::append_meeting(const PlainBox& box, const Visit& visit,
                             std::vector<std::uint32_t>& places) const {
  places.resize(visit.end + (visit.end - visit.begin));
  std::size_t end = visit.end;
  for (std::size_t i = visit.begin; i < visit.end; ++i) {
    places[end] = places[i];  // without a branch
    end += meet(node(visit.level_of_others, places[i]), box) ? 1 : 0;
  }
  places.resize(end);
}

/// Appends the children that meet the box.
/// @param level of the nodes whose places are in the list from `begin` on
void BoxTree::append_children(const PlainBox& box, std::size_t level, std::size_t begin,
                              std::vector<std::uint32_t>& places) const {
  const std::size_t parents_end = places.size();
  places.resize(parents_end + fan * (parents_end - begin));
  const std::size_t count = count_at(level - 1);
  std::size_t end = parents_end;
  for (std::size_t i = begin; i < parents_end; ++i) {
    const std::size_t first = fan * std::size_t{places[i]};
    for (std::size_t child = first; child < std::min(first + fan, count); ++child) {
      places[end] = static_cast<std::uint32_t>(child);
      end += meet(node(level - 1, child), box) ? 1 : 0;
    }
  }
  places.resize(end);
}

}  // namespace fiber
