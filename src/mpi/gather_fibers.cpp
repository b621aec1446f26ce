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

/// A point of a fibre, with what is known of it there.
struct GatheredPoint {
  Eigen::Vector3d point{};  // [m]
  double radius = 0.0;      // [m]
  std::int32_t joint = -1;
};

/// Parts and their points, those of a part one after another.
struct GatheredParts {
  std::vector<GatheredPart> parts;
  std::vector<GatheredPoint> points;
};

GatheredParts parts_of(const DistributedFibers& fibers, const FiberTopology& topology) {
  GatheredParts all;
  all.points.reserve(fibers.parts.point_count());
  for (std::size_t part = 0; part < fibers.names.size(); ++part) {
    const std::uint32_t begin = fibers.parts.offsets()[part];
    const std::uint32_t end = fibers.parts.offsets()[part + 1];
    all.parts.push_back({{{fibers.names[part].fiber, fibers.names[part].first_segment},
                          end - begin - 1,
                          all.points.size()},
                         !topology.closed.empty() && topology.closed[part] != 0});
    for (std::uint32_t p = begin; p < end; ++p) {
      all.points.push_back({fibers.parts.points()[p], fibers.parts.radius_at(part, p),
                            topology.joints.empty() ? -1 : topology.joints[p]});
    }
  }
  return all;
}

/// Makes whole fibres of parts that are sorted.
class WholeFiberBuilder {
 public:
  void add(const GatheredParts& all) {
    for (const GatheredPart& part : all.parts) {
      const GatheredPoint* point = all.points.data() + part.run.begin;
      const GatheredPoint* const end = point + part.run.count + 1;
      if (part.run.first.segment == 0) {
        end_fiber();
        number_ = part.run.first.fiber;
        topology_.closed.push_back(part.is_closed ? 1 : 0);
      } else {
        require_radius(part.run.first.segment, point->radius, radii_.back());
        ++point;
      }
      for (; point != end; ++point) {
        points_.push_back(point->point);
        radii_.push_back(point->radius);
        topology_.joints.push_back(point->joint);
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
      topology_.joints.pop_back();
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

/// The parts of all ranks as one set, in the order in which ranks have them.
GatheredParts joined_parts(const PerRank<GatheredPart>& parts, std::vector<GatheredPoint> points) {
  GatheredParts all{joined(parts), std::move(points)};
  std::uint64_t begin = 0;
  for (GatheredPart& part : all.parts) {
    part.run.begin = begin;
    begin += part.run.count + 1;
  }
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
  GatheredParts own = parts_of(fibers, topology);
  PerRank<GatheredPart> parts(static_cast<std::size_t>(ranks.size()));
  PerRank<GatheredPoint> points(parts.size());
  parts[0] = std::move(own.parts);
  points[0] = std::move(own.points);
  const FiberNames names = std::move(fibers.fiber_names);
  fibers = {};
  parts = ranks.exchange(std::move(parts));
  GatheredParts all = joined_parts(parts, joined(ranks.exchange(std::move(points))));
  std::sort(all.parts.begin(), all.parts.end(),
            [](const GatheredPart& x, const GatheredPart& y) { return x.run.first < y.run.first; });
  WholeFibers whole;
  ranks.throw_on_all(error_in([&] {
    WholeFiberBuilder builder;
    builder.add(all);
    whole = {builder.build(joints.tolerance()), names_of(all, names)};
  }));
  return whole;
}

}  // namespace fiber
