#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "src/environment/allowed_contacts.hpp"
#include "src/environment/object_path.hpp"
#include "src/sim/contact/add_obstacle_contacts.hpp"
#include "src/sim/contact/contact_set.hpp"
#include "src/sim/effects/doubled_fibers.hpp"
#include "src/sim/require.hpp"
#include "src/sim/solver/step_bound.hpp"

namespace fiber {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// The room that a rod may come to in a solve.
struct MovingObstacleContact::RodReach {
  WorldBox box;         // of the rod
  double needed = 0.0;  // the distance within which it may reach contacts [m]
};

/// Looks for the contacts of one solve: of each shape with each rod, whose box tells of most that
/// there are none.
class MovingObstacleContact::Finder {
 public:
  Finder(const EnvironmentContact::Options& options, const Rods& rods, const TravelBound& bound,
         const FiberAssembly& fibers, std::vector<RodReach>& reaches, ContactSet& found)
      : options_(options),
        rods_(rods),
        bound_(bound),
        fibers_(fibers),
        reaches_(reaches),
        found_(found) {
    reaches.clear();
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      WorldBox box;
      double expected = 0.0;
      for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
        box.extend(rods.positions[i]);
        expected = std::max(expected, bound.expected[i].squaredNorm());
      }
      reaches.push_back({box, std::sqrt(expected) + bound.by_rod[rod] +
                                  (1.0 + Barrier::half_width) * rods.radii[rod]});
    }
  }

  /// @param parts that may touch
  /// @param index of the object in these
  void find(const ObstacleShape& shape, const AllowedParts* parts, std::uint32_t index) {
    const ObstacleMotion& motion = *shape.moving->motion;
    const Isometry3d last = motion.end * shape.moving->in_object;
    const ObjectPath path(shape.pose, last);
    const WorldBox box = world_box(*shape.shape, shape.pose);
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      const double within =
          reaches_[rod].needed + path.way().norm() + turn_length(shape, path, rod);
      if (!(reaches_[rod].box.exteriorDistance(box) > within)) {
        find_of(shape, rod, within, [&](std::uint32_t element) {
          return parts != nullptr && parts->holds(fibers_, {rod, element}, index);
        });
      }
    }
  }

 private:
  /// By how much the shape's turn may bring it nearer to a rod [m].
  double turn_length(const ObstacleShape& shape, const ObjectPath& path, std::uint32_t rod) const {
    if (!path.turns()) {
      return 0.0;
    }
    if (is_bounded(*shape.shape)) {
      return path.turn_length(reach(*shape.shape));
    }
    // Only the part of a plane near the rod counts.
    const Vector3d origin = shape.pose.translation();
    const WorldBox& box = reaches_[rod].box;
    const double far =
        (box.max() - origin).cwiseAbs().cwiseMax((origin - box.min()).cwiseAbs()).norm();
    return path.turn_length(far + reaches_[rod].needed + path.way().norm());
  }

  /// @param is_allowed whether an element may overlap: of even index nodes, of odd index edges
  template <class IsAllowed>
  void find_of(const ObstacleShape& shape, std::uint32_t rod, double within,
               const IsAllowed& is_allowed) {
    const bool has_edges = !std::holds_alternative<HalfSpaceShape>(*shape.shape);
    const std::uint32_t first = rods_.first(rod);
    const std::uint32_t last = rods_.end(rod) - 1;
    for (std::uint32_t node = first; node <= last; ++node) {
      const Vector3d& p0 = rods_.positions[node];
      if (!is_allowed(2 * (node - first)) && is_near(shape, p0, p0, within)) {
        const bool is_last = node == last;
        add(shape, rod, is_last ? node - 1 : node,
            is_last ? EdgePart::last_node() : EdgePart::first_node(), within);
      }
      if (node == last || !has_edges || is_allowed(2 * (node - first) + 1)) {
        continue;
      }
      const Vector3d& p1 = rods_.positions[node + 1];
      if (is_near(shape, p0, p1, within)) {
        found_.obstacle_edges.push_back({rod, node, &shape, 0.0, p0, p0, {p0, p1}});
        add(shape, rod, node, EdgePart::whole(), within);
      }
    }
  }

  static bool is_near(const ObstacleShape& shape, const Vector3d& p0, const Vector3d& p1,
                      double within) {
    return axis_distance(*shape.shape, shape.to_shape * p0, shape.to_shape * p1, within).lower <=
           within;
  }

  void add(const ObstacleShape& shape, std::uint32_t rod, std::uint32_t edge, const EdgePart& part,
           double within) {
    add_obstacle_contacts(shape, rods_, rod, edge, part, options_, within,
                          found_.obstacle_contacts);
  }

  const EnvironmentContact::Options& options_;
  const Rods& rods_;
  const TravelBound& bound_;
  const FiberAssembly& fibers_;
  const std::vector<RodReach>& reaches_;  // by rod
  ContactSet& found_;
};

MovingObstacleContact::MovingObstacleContact(std::shared_ptr<const ObstacleMotions> motions,
                                             const EnvironmentContact::Options& options)
    : motions_(std::move(motions)), options_(options) {
  require_not_negative("environment_contact: the stiffness", options.stiffness, " N/m");
  require_share("environment_contact: the restitution", options.restitution);
  for (AllowedPair& pair : options_.allowed) {
    pair = doubled(pair);
  }
  take_shapes();
}

/// Those of the obstacles that there are now.
void MovingObstacleContact::take_shapes() {
  revision_ = motions_->revision();
  moving_.clear();
  shapes_.clear();
  if (!options_.allowed.empty()) {
    std::vector<EnvironmentObject> objects;
    for (const MovingObstacle& obstacle : motions_->obstacles()) {
      objects.push_back(obstacle.object);
    }
    allowed_ = std::make_unique<const AllowedParts>(options_.allowed, objects);
  }
  std::size_t count = 0;
  for (const MovingObstacle& obstacle : motions_->obstacles()) {
    count += obstacle.object.shapes.size();
  }
  moving_.reserve(count);  // shapes refer to these
  shapes_.reserve(count);
  std::uint32_t object = 0;
  for (const MovingObstacle& obstacle : motions_->obstacles()) {
    const ObstacleMotion& motion = motions_->motions()[object];
    for (const PlacedShape& placed : obstacle.object.shapes) {
      moving_.push_back({&motion, placed.pose});
      shapes_.emplace_back(placed.shape, motion.start * placed.pose,
                           motions_->first_index() + object);
      shapes_.back().moving = &moving_.back();
    }
    ++object;
  }
}

MovingObstacleContact::~MovingObstacleContact() = default;

void MovingObstacleContact::find(const Rods& rods, const TravelBound& bound, ContactSet& found) {
  if (revision_ != motions_->revision()) {
    take_shapes();
  }
  if (shapes_.empty()) {
    return;
  }
  if (allowed_ != nullptr && fibers_.point_count() != 2 * rods.positions.size()) {
    fibers_ = doubled_fibers(rods);
  }
  Finder finder(options_, rods, bound, fibers_, reaches_, found);
  for (ObstacleShape& shape : shapes_) {
    shape.pose = shape.moving->motion->start * shape.moving->in_object;
    shape.to_shape = shape.pose.inverse(Eigen::Isometry);
    finder.find(shape, allowed_.get(), shape.object - motions_->first_index());
  }
}

}  // namespace fiber
