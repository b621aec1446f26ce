#include "src/mpi/global_joints.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "src/geometry/disjoint_sets.hpp"
#include "src/geometry/fiber_graph.hpp"
#include "src/mpi/part_topology.hpp"

namespace fiber {
namespace {

/// A point as the rank hears of it that compares the parts of its fibre.
struct PointNotice {
  GlobalJointPoint point;
  bool is_closed = false;
  int rank = 0;
};

bool has_smaller_place(const GlobalJointPoint& x, const GlobalJointPoint& y) {
  return std::tie(x.fiber, x.point) < std::tie(y.fiber, y.point);
}

/// Tells the ranks that compare fibres of the points that have a number, and of the ends of parts,
/// which two parts have.
std::vector<PointNotice> exchange_notices(const Communicator& ranks, const FiberAssembly& parts,
                                          const std::vector<FiberPart>& names,
                                          const FiberTopology& topology) {
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<PointNotice> notices(size);
  for (std::size_t part = 0; part < names.size(); ++part) {
    const std::uint32_t begin = parts.offsets()[part];
    const std::uint32_t last = parts.offsets()[part + 1] - 1;
    const bool is_closed = !topology.closed.empty() && topology.closed[part] != 0;
    for (std::uint32_t p = begin; p <= last; ++p) {
      const std::int32_t joint = topology.joints.empty() ? -1 : std::max(-1, topology.joints[p]);
      if (joint >= 0 || p == begin || p == last) {
        notices[names[part].fiber % size].push_back(
            {{names[part].fiber, names[part].first_segment + (p - begin), joint},
             is_closed,
             ranks.rank()});
      }
    }
  }
  std::vector<PointNotice> all = joined(ranks.exchange(std::move(notices)));
  std::stable_sort(all.begin(), all.end(), [](const PointNotice& x, const PointNotice& y) {
    return has_smaller_place(x.point, y.point);
  });
  return all;
}

std::string text_of_joint(std::int32_t joint) {
  return joint < 0 ? "in no joint" : "in joint " + std::to_string(joint);
}

/// "" if those of one fibre, the first and the last point among them, agree.
/// @param first, last the first one and the last one
std::string disagreement_in(const PointNotice* first, const PointNotice* last) {
  const std::string fiber = "fibre " + std::to_string(first->point.fiber);
  for (const PointNotice* x = first; x < last; ++x) {
    const PointNotice& y = x[1];
    if (x->is_closed != y.is_closed) {
      return fiber + ": rank " + std::to_string(x->rank) + " has a part of it as " +
             (x->is_closed ? "closed" : "open") + ", rank " + std::to_string(y.rank) + " as " +
             (y.is_closed ? "closed" : "open");
    }
    if (x->point.point == y.point.point && x->point.joint != y.point.joint) {
      return fiber + ", point " + std::to_string(x->point.point) + ": rank " +
             std::to_string(x->rank) + " has it " + text_of_joint(x->point.joint) + ", rank " +
             std::to_string(y.rank) + ' ' + text_of_joint(y.point.joint);
    }
  }
  if (!first->is_closed) {
    return "";
  }
  if (last->point.point < FiberGraph::min_closed_points) {
    return FiberGraph::error_of_closed(first->point.fiber, last->point.point);
  }
  return first->point.joint == last->point.joint
             ? ""
             : fiber + ": is closed, and its first point is " + text_of_joint(first->point.joint) +
                   ", but where it is repeated as the last one " + text_of_joint(last->point.joint);
}

/// The points that have a number, each once, of the fibres that this rank compares.
/// @throws std::invalid_argument where parts do not agree
std::vector<GlobalJointPoint> numbered_points_of(const std::vector<PointNotice>& notices) {
  std::vector<GlobalJointPoint> numbered;
  for (auto first = notices.begin(); first != notices.end();) {
    const auto end = std::find_if(first, notices.end(), [&](const PointNotice& other) {
      return other.point.fiber != first->point.fiber;
    });
    const PointNotice& last = *(end - 1);
    if (const std::string error = disagreement_in(&*first, &last); !error.empty()) {
      throw std::invalid_argument(error);
    }
    for (; first != end; ++first) {
      const bool is_new = numbered.empty() || has_smaller_place(numbered.back(), first->point);
      const bool is_repeated = last.is_closed && first->point.point == last.point.point;
      if (first->point.joint >= 0 && is_new && !is_repeated) {
        numbered.push_back(first->point);
      }
    }
  }
  return numbered;
}

}  // namespace

GlobalJoints::GlobalJoints(const Communicator& ranks, const FiberAssembly& parts,
                           const std::vector<FiberPart>& names, const FiberTopology& topology)
    : is_empty_(ranks.all(!joins_anything(topology))) {
  if (is_empty_) {
    return;
  }
  tolerance_ = common_tolerance(ranks, topology);
  const std::vector<PointNotice> notices = exchange_notices(ranks, parts, names, topology);
  std::vector<GlobalJointPoint> numbered;
  ranks.throw_on_all(error_in([&] { numbered = numbered_points_of(notices); }));
  take(joined(
      ranks.exchange(PerRank<GlobalJointPoint>(static_cast<std::size_t>(ranks.size()), numbered))));
}

/// Takes all points that have a number, and leaves out those that are alone with it.
void GlobalJoints::take(std::vector<GlobalJointPoint> numbered) {
  std::sort(numbered.begin(), numbered.end(),
            [](const GlobalJointPoint& x, const GlobalJointPoint& y) {
              return std::tie(x.joint, x.fiber, x.point) < std::tie(y.joint, y.fiber, y.point);
            });
  const auto is_same_joint = [&](std::size_t i, std::size_t j) {
    return j < numbered.size() && numbered[i].joint == numbered[j].joint;
  };
  std::vector<std::size_t> before;  // by point, the one before it in its joint, or itself
  for (std::size_t i = 0; i < numbered.size(); ++i) {
    const bool goes_on = i > 0 && is_same_joint(i, i - 1);
    if (goes_on || is_same_joint(i, i + 1)) {
      before.push_back(goes_on ? points_.size() - 1 : points_.size());
      points_.push_back(numbered[i]);
    } else if (!lonely_) {
      lonely_ = numbered[i].joint;
    }
  }
  for (const GlobalJointPoint& point : points_) {
    components_.push_back({point.fiber, point.fiber});
    if (numbers_.empty() || numbers_.back() != point.joint) {
      numbers_.push_back(point.joint);
    }
  }
  std::sort(components_.begin(), components_.end(),
            [](const FiberComponent& x, const FiberComponent& y) { return x.fiber < y.fiber; });
  components_.erase(std::unique(components_.begin(), components_.end(),
                                [](const FiberComponent& x, const FiberComponent& y) {
                                  return x.fiber == y.fiber;
                                }),
                    components_.end());
  const auto place_of = [this](std::uint64_t fiber) {
    return static_cast<std::uint32_t>(
        std::lower_bound(components_.begin(), components_.end(), fiber,
                         [](const FiberComponent& x, std::uint64_t y) { return x.fiber < y; }) -
        components_.begin());
  };
  DisjointSets joined(static_cast<std::uint32_t>(components_.size()));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    joined.join(place_of(points_[i].fiber), place_of(points_[before[i]].fiber));
  }
  std::vector<std::uint32_t> roots;
  joined.find_roots(roots);
  for (std::size_t i = 0; i < components_.size(); ++i) {
    components_[i].component = components_[roots[i]].fiber;
  }
  std::sort(points_.begin(), points_.end(), has_smaller_place);
}

GlobalJoints::Points GlobalJoints::points_of(std::uint64_t fiber) const {
  const auto first = std::lower_bound(points_.begin(), points_.end(), GlobalJointPoint{fiber, 0},
                                      has_smaller_place);
  const auto end = std::find_if(first, points_.end(), [fiber](const GlobalJointPoint& point) {
    return point.fiber != fiber;
  });
  return {points_.data() + (first - points_.begin()), points_.data() + (end - points_.begin())};
}

std::optional<std::uint64_t> GlobalJoints::component_of(std::uint64_t fiber) const {
  const auto found =
      std::lower_bound(components_.begin(), components_.end(), fiber,
                       [](const FiberComponent& x, std::uint64_t y) { return x.fiber < y; });
  return found == components_.end() || found->fiber != fiber ? std::nullopt
                                                             : std::optional(found->component);
}

std::int32_t GlobalJoints::next_free_number(std::int32_t last) const {
  auto taken = std::upper_bound(numbers_.begin(), numbers_.end(), last);
  for (++last; taken != numbers_.end() && *taken == last; ++taken) {
    ++last;
  }
  return last;
}

std::optional<std::int32_t> find_lonely_joint(const Communicator& ranks,
                                              const DistributedFibers& fibers) {
  FiberTopology topology;
  ranks.throw_on_all(error_in([&] { topology = part_topology(fibers.parts, fibers.topology); }));
  return GlobalJoints(ranks, fibers.parts, fibers.names, topology).lonely();
}

}  // namespace fiber
