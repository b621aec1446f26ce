#include "src/mpi/gather_fibers.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/geometry/fiber_graph.hpp"
#include "src/io/number.hpp"
#include "src/io/radii.hpp"
#include "src/mpi/fiber_chains.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/global_joints.hpp"
#include "src/mpi/part_topology.hpp"

namespace fiber {
namespace {

/// A part of a fibre on its way to rank 0.
struct GatheredPart {
  FiberRun run;
  bool is_closed = false;
};

/// Parts and their nodes, those of a part one after another; unlike elsewhere, each node has the
/// radius of its point.
struct GatheredParts {
  std::vector<GatheredPart> parts;
  std::vector<FiberNode> nodes;
  std::vector<std::int32_t> joints;  // by node; empty where no rank joins anything
};

GatheredParts parts_of(const DistributedFibers& fibers, const FiberTopology& topology,
                       bool has_joints) {
  GatheredParts all;
  all.nodes.reserve(fibers.parts.point_count());
  for (std::size_t part = 0; part < fibers.names.size(); ++part) {
    const std::uint32_t begin = fibers.parts.offsets()[part];
    const std::uint32_t end = fibers.parts.offsets()[part + 1];
    all.parts.push_back({{{fibers.names[part].fiber, fibers.names[part].first_segment},
                          end - begin - 1,
                          all.nodes.size()},
                         !topology.closed.empty() && topology.closed[part] != 0});
    for (std::uint32_t p = begin; p < end; ++p) {
      all.nodes.push_back({fibers.parts.points()[p], fibers.parts.radius_at(part, p)});
    }
  }
  all.joints = topology.joints;
  if (has_joints) {
    all.joints.resize(all.nodes.size(), -1);
  }
  return all;
}

/// Makes whole fibres of parts that are sorted.
class WholeFiberBuilder {
 public:
  void add(const GatheredParts& all) {
    for (const GatheredPart& part : all.parts) {
      std::uint64_t node = part.run.begin;
      const std::uint64_t end = node + part.run.count + 1;
      if (part.run.first.segment == 0) {
        end_fiber();
        number_ = part.run.first.fiber;
        topology_.closed.push_back(part.is_closed ? 1 : 0);
      } else {
        require_radius(part.run.first.segment, all.nodes[node].radius, radii_.back());
        ++node;
      }
      for (; node != end; ++node) {
        points_.push_back(all.nodes[node].point);
        radii_.push_back(all.nodes[node].radius);
        if (!all.joints.empty()) {
          topology_.joints.push_back(all.joints[node]);
        }
      }
    }
    end_fiber();
  }

  FiberAssembly build(std::optional<double> joint_tolerance) {
    if (points_.size() > UINT32_MAX) {
      throw std::invalid_argument(std::to_string(points_.size()) +
                                  " points, one rank can have 4294967295");
    }
    if (points_.empty()) {
      return {};
    }
    topology_.joint_tolerance = joint_tolerance;
    return {std::move(points_), std::move(offsets_), shared_if_equal(std::move(radii_)), topology_};
  }

 private:
  void require_radius(std::uint64_t segment, double radius, double before) const {
    if (radius != before) {
      throw std::invalid_argument("fibre " + std::to_string(number_) + ": the part from segment " +
                                  std::to_string(segment) + " on has the radius " +
                                  fiber::text_of(radius) + " m at its start, the part before has " +
                                  fiber::text_of(before) + " m there, which must be the same");
    }
  }

  /// Leaves out the last point of a closed fibre, which is its first one.
  void end_fiber() {
    if (points_.size() == offsets_.back()) {
      return;
    }
    if (topology_.closed.back() != 0) {
      const std::size_t first = offsets_.back();
      FiberGraph::require_repeated(number_, points_[first], points_.back());
      if (radii_[first] != radii_.back()) {
        throw std::invalid_argument(
            "fibre " + std::to_string(number_) + ": is closed, and has the radius " +
            fiber::text_of(radii_[first]) + " m at its first point, " +
            fiber::text_of(radii_.back()) + " m where it is repeated, which must be the same");
      }
      points_.pop_back();
      radii_.pop_back();
      topology_.joints.resize(std::min(topology_.joints.size(), points_.size()));
    }
    offsets_.push_back(static_cast<std::uint32_t>(points_.size()));
  }

  std::uint64_t number_ = 0;  // of the fibre that is added
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> offsets_{0};
  std::vector<double> radii_;
  FiberTopology topology_;
};

/// The names of the fibres of sorted parts, each once.
FiberNames names_of(const GatheredParts& all, const FiberNames& by_number) {
  std::vector<std::string> names;
  for (const GatheredPart& part : all.parts) {
    if (part.run.first.segment == 0) {
      names.push_back(by_number.of(part.run.first.fiber));
    }
  }
  return FiberNames(std::move(names));
}

/// Sends a list to rank 0.
/// @return those of all ranks, one after another
template <class Item>
std::vector<Item> on_root(const Communicator& ranks, std::vector<Item> items) {
  PerRank<Item> to(static_cast<std::size_t>(ranks.size()));
  to[0] = std::move(items);
  return joined(ranks.exchange(std::move(to)));
}

/// Brings the parts of all ranks together on rank 0, sorted.
GatheredParts parts_on_root(const Communicator& ranks, GatheredParts own, bool has_joints) {
  GatheredParts all;
  all.parts = on_root(ranks, std::move(own.parts));
  all.nodes = on_root(ranks, std::move(own.nodes));
  if (has_joints) {
    all.joints = on_root(ranks, std::move(own.joints));
  }
  std::uint64_t begin = 0;
  for (GatheredPart& part : all.parts) {
    part.run.begin = begin;
    begin += part.run.count + 1;
  }
  std::sort(all.parts.begin(), all.parts.end(),
            [](const GatheredPart& x, const GatheredPart& y) { return x.run.first < y.run.first; });
  return all;
}

}  // namespace

WholeFibers gather_fibers(const Communicator& ranks, DistributedFibers fibers) {
  const FiberChains chains(ranks, fibers.parts, fibers.names);
  // Parts that do not meet are refused; of the lengths hardly any are kept.
  chains.arc_lengths(ranks, fibers.parts, fibers.names, 1U << 20U);
  FiberTopology topology;
  ranks.throw_on_all(error_in([&] { topology = part_topology(fibers.parts, fibers.topology); }));
  // Parts that are not joined alike are refused, too.
  const GlobalJoints joints(ranks, fibers.parts, fibers.names, topology);
  const bool has_joints = !joints.empty();
  GatheredParts own = parts_of(fibers, topology, has_joints);
  const FiberNames names = std::move(fibers.fiber_names);
  fibers = {};
  const GatheredParts all = parts_on_root(ranks, std::move(own), has_joints);
  WholeFibers whole;
  ranks.throw_on_all(error_in([&] {
    WholeFiberBuilder builder;
    builder.add(all);
    whole = {builder.build(joints.tolerance()), names_of(all, names)};
  }));
  return whole;
}

}  // namespace fiber
