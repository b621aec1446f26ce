#include "src/mpi/joined_fibers.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "src/geometry/fiber_graph.hpp"
#include "src/mpi/part_topology.hpp"

namespace fiber {
namespace {

/// A part that another rank needs.
struct JoinedRun {
  FiberRun run;
  bool is_closed = false;
};

template <class Item, class KeyOf>
void sort_and_leave_one_each(std::vector<Item>& items, const KeyOf& key_of) {
  std::sort(items.begin(), items.end(),
            [&](const Item& x, const Item& y) { return key_of(x) < key_of(y); });
  items.erase(std::unique(items.begin(), items.end(),
                          [&](const Item& x, const Item& y) { return key_of(x) == key_of(y); }),
              items.end());
}

}  // namespace

void JoinedFibers::set_parts(const Communicator& ranks, const FiberAssembly& parts,
                             const std::vector<FiberPart>& names, const FiberTopology& topology) {
  topology_ = topology;
  joints_ = GlobalJoints(ranks, parts, names, topology);
}

/// Brings those who own pieces of a component to those who bring parts of it.
/// @param owners of the pieces that this rank brings
/// @return the owners of all pieces of the components that this rank brings a part of, sorted
std::vector<JoinedFibers::ComponentAtRank> JoinedFibers::exchange_owners(
    const Communicator& ranks, std::vector<ComponentAtRank> owners) const {
  const auto key_of = [](const ComponentAtRank& x) { return std::tuple(x.component, x.rank); };
  const auto by_component = [](const ComponentAtRank& x, const ComponentAtRank& y) {
    return x.component < y.component;
  };
  sort_and_leave_one_each(owners, key_of);
  // Each component has a rank where its owners meet.
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<ComponentAtRank> met(size);
  for (const ComponentAtRank& owner : owners) {
    met[owner.component % size].push_back(owner);
  }
  met = ranks.exchange(std::move(met));
  std::vector<ComponentAtRank> all = joined(met);
  sort_and_leave_one_each(all, key_of);
  for (std::vector<ComponentAtRank>& some : met) {
    std::vector<ComponentAtRank> reply;
    for (auto asked = some.begin(); asked != some.end(); ++asked) {
      if (asked == some.begin() || (asked - 1)->component != asked->component) {
        const auto [first, last] = std::equal_range(all.begin(), all.end(), *asked, by_component);
        reply.insert(reply.end(), first, last);
      }
    }
    some = std::move(reply);
  }
  all = joined(ranks.exchange(std::move(met)));
  sort_and_leave_one_each(all, key_of);
  return all;
}

void JoinedFibers::set_owners(const Communicator& ranks, const FiberAssembly& parts,
                              const std::vector<FiberPart>& names, const PieceRoutes& routes) {
  const auto size = static_cast<std::size_t>(ranks.size());
  parts_for_.assign(size, {});
  closed_.clear();
  graph_ = nullptr;
  fibers_ = LocalFibers();
  if (joints_.empty()) {
    return;
  }
  // A closed fibre that has no joint is a component by itself.
  std::vector<std::optional<std::uint64_t>> components;  // by part
  for (std::size_t part = 0; part < names.size(); ++part) {
    components.push_back(joints_.component_of(names[part].fiber));
    if (!components.back() && is_closed_part(part)) {
      components.back() = names[part].fiber;
    }
  }
  std::vector<ComponentAtRank> owners;
  routes.for_each_owner([&](std::uint32_t part, int owner) {
    if (components[part]) {
      owners.push_back({*components[part], owner});
    }
  });
  owners = exchange_owners(ranks, std::move(owners));

  PerRank<JoinedRun> runs(size);
  for (std::uint32_t part = 0; part < names.size(); ++part) {
    if (!components[part]) {
      continue;
    }
    const std::uint64_t count = parts.offsets()[part + 1] - parts.offsets()[part] - 1;
    const JoinedRun run{{{names[part].fiber, names[part].first_segment}, count, 0, 0.0},
                        is_closed_part(part)};
    const auto first = std::lower_bound(
        owners.begin(), owners.end(), *components[part],
        [](const ComponentAtRank& x, std::uint64_t component) { return x.component < component; });
    for (auto owner = first; owner != owners.end() && owner->component == *components[part];
         ++owner) {
      parts_for_[static_cast<std::size_t>(owner->rank)].push_back(part);
      runs[static_cast<std::size_t>(owner->rank)].push_back(run);
    }
  }
  std::vector<FiberRun> here;
  for (const JoinedRun& run : joined(ranks.exchange(std::move(runs)))) {
    here.push_back(run.run);
    if (run.is_closed) {
      closed_.push_back(run.run.first.fiber);
    }
  }
  sort_and_leave_one_each(closed_, [](std::uint64_t fiber) { return fiber; });
  ranks.throw_on_all(error_in([&] { fibers_.assign(std::move(here)); }));
}

void JoinedFibers::send_nodes(const Communicator& ranks, const FiberAssembly& parts) {
  if (joints_.empty()) {
    return;
  }
  PerRank<FiberNode> nodes(parts_for_.size());
  for (std::size_t other = 0; other < nodes.size(); ++other) {
    for (const std::uint32_t part : parts_for_[other]) {
      const std::uint32_t last = parts.offsets()[part + 1] - 1;
      for (std::uint32_t p = parts.offsets()[part]; p <= last; ++p) {
        nodes[other].push_back({parts.points()[p], p < last ? parts.segment_radius(p) : 0.0});
      }
    }
  }
  const std::vector<FiberNode> all = joined(ranks.exchange(std::move(nodes)));
  if (graph_ != nullptr) {
    fibers_.open();
  }
  const FiberNode* next = all.data();
  for (std::size_t number = 0; number < fibers_.runs().size(); ++number) {
    next = fibers_.place(number, 0.0, next);
  }
  ranks.throw_on_all(error_in([&] {
    fibers_.close();
    if (!fibers_.runs().empty()) {
      graph_ = graph_ != nullptr ? graph_ : make_graph();
      fibers_.join(graph_);
      require_what_is_joined_meets();
    }
    loops_.reset(fibers_.fibers());
  }));
}

std::shared_ptr<const FiberGraph> JoinedFibers::make_graph() const {
  const std::vector<std::uint32_t>& offsets = fibers().offsets();
  FiberTopology topology;
  topology.joint_tolerance = joints_.tolerance();
  topology.joints.assign(fibers().point_count(), -1);
  std::int32_t free = -1;
  for (std::size_t fiber = 0; fiber < fibers().fiber_count(); ++fiber) {
    const GlobalSegment& name = fibers_.first_ids()[fiber];
    assert(name.segment == 0);
    std::int32_t* const numbers = topology.joints.data() + offsets[fiber];
    for (const GlobalJointPoint& point : joints_.points_of(name.fiber)) {
      numbers[point.point] = point.joint;
    }
    if (is_closed(name.fiber)) {
      if (numbers[0] < 0) {
        numbers[0] = free = joints_.next_free_number(free);
      }
      topology.joints[offsets[fiber + 1] - 1] = numbers[0];
    }
  }
  return FiberGraph::make(offsets, topology);
}

void JoinedFibers::require_what_is_joined_meets() const {
  const std::vector<Eigen::Vector3d>& points = fibers().points();
  std::vector<std::uint64_t> numbers;
  for (std::size_t fiber = 0; fiber < fibers().fiber_count(); ++fiber) {
    numbers.push_back(fibers_.first_ids()[fiber].fiber);
    if (is_closed(numbers.back())) {
      FiberGraph::require_repeated(numbers.back(), points[fibers().offsets()[fiber]],
                                   points[fibers().offsets()[fiber + 1] - 1]);
    }
  }
  graph_->require_joints_meet(fibers(), points, numbers);
}

FiberTopology JoinedFibers::topology_of(const LocalFibers& own) const {
  FiberTopology topology;
  if (joints_.empty()) {
    return topology;
  }
  topology.joint_tolerance = joints_.tolerance();
  topology.joints.assign(own.fibers().point_count(), -1);
  for (std::size_t stretch = 0; stretch < own.first_ids().size(); ++stretch) {
    const GlobalSegment& first = own.first_ids()[stretch];
    const std::uint32_t begin = own.fibers().offsets()[stretch];
    const std::uint64_t last = first.segment + (own.fibers().offsets()[stretch + 1] - begin - 1);
    topology.closed.push_back(is_closed(first.fiber) ? 1 : 0);
    const std::optional<std::uint32_t> whole = place_of(first.fiber);
    if (!whole) {
      continue;
    }
    const auto set = [&](std::uint64_t point, std::int32_t joint) {
      if (first.segment <= point && point <= last) {
        topology.joints[begin + (point - first.segment)] = joint;
      }
    };
    for (const GlobalJointPoint& point : joints_.points_of(first.fiber)) {
      set(point.point, point.joint);
      if (point.point == 0 && is_closed(first.fiber)) {
        set(fibers().offsets()[*whole + 1] - fibers().offsets()[*whole] - 1, point.joint);
      }
    }
  }
  return joins_anything(topology) ? topology : FiberTopology();
}

bool JoinedFibers::is_closed(std::uint64_t fiber) const {
  return std::binary_search(closed_.begin(), closed_.end(), fiber);
}

/// The place of a fibre among fibers().
std::optional<std::uint32_t> JoinedFibers::place_of(std::uint64_t fiber) const {
  const std::vector<GlobalSegment>& names = fibers_.first_ids();
  const auto found = std::lower_bound(names.begin(), names.end(), GlobalSegment{fiber, 0});
  return found == names.end() || found->fiber != fiber
             ? std::nullopt
             : std::optional(static_cast<std::uint32_t>(found - names.begin()));
}

std::optional<PointPair> JoinedFibers::points_of(const GlobalSegment& a,
                                                 const GlobalSegment& b) const {
  const std::optional<std::uint32_t> fiber_a = place_of(a.fiber);
  const std::optional<std::uint32_t> fiber_b =
      !fiber_a || a.fiber == b.fiber ? fiber_a : place_of(b.fiber);
  if (!fiber_b) {
    return std::nullopt;
  }
  return PointPair{fibers_.point_of(*fiber_a, static_cast<std::uint32_t>(a.segment)),
                   fibers_.point_of(*fiber_b, static_cast<std::uint32_t>(b.segment))};
}

}  // namespace fiber
