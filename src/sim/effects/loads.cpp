#include "fiber_proximity/sim/loads.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/edges.hpp"
#include "src/sim/require.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

std::string name_of(const Loads::Load& load) { return "load on rod " + std::to_string(load.rod); }

[[noreturn]] void refuse(const Loads::Load& load, const std::string& problem) {
  throw std::invalid_argument(name_of(load) + ": " + problem);
}

bool is_finite(double value) { return std::isfinite(value); }
bool is_finite(const Vector3d& value) { return value.allFinite(); }

template <class Value>
void require_finite(const Loads::Load& load, const char* what, const TimeTable<Value>& table) {
  for (const auto& entry : table.entries()) {
    if (!is_finite(entry.value)) {
      refuse(load, std::string(what) + " must be finite");
    }
  }
}

template <class Value>
bool is_absent(const TimeTable<Value>& table, const Value& none) {
  return std::all_of(table.entries().begin(), table.entries().end(),
                     [&](const auto& entry) { return entry.value == none; });
}

void validate_values(const Rods& rods, const Loads::Load& load) {
  require_finite(load, "its force", load.force);
  require_finite(load, "its moment", load.moment);
  require_finite(load, "its torque", load.torque);
  require_not_negative(name_of(load) + ": the mass", load.mass, load.part ? " kg/m" : " kg");
  const bool is_at_end = load.node == 0 || load.node + 1 == rods.node_count(load.rod);
  if (!is_absent(load.moment, Vector3d(Vector3d::Zero())) && (load.part || !is_at_end)) {
    refuse(load, "a moment must be at an end of the rod: in between only a torque may act");
  }
  if (!is_absent(load.torque, 0.0) && rods.angles.empty()) {
    refuse(load, "a torque takes rods with twist: without it cross-sections turn freely");
  }
}

void validate(const Rods& rods, const Loads::Load& load) {
  if (load.rod >= rods.count()) {
    refuse(load, "there are " + std::to_string(rods.count()) + " rods");
  }
  if (!load.part && load.node >= rods.node_count(load.rod)) {
    refuse(load, "it is at node " + std::to_string(load.node) + ", the rod has " +
                     std::to_string(rods.node_count(load.rod)) + " nodes");
  }
  if (load.part) {
    const double length = std::accumulate(rods.rest_lengths.begin() + rods.first(load.rod),
                                          rods.rest_lengths.begin() + rods.end(load.rod), 0.0);
    if (!(load.part->from >= 0.0 && load.part->from < load.part->to && load.part->to <= length)) {
      refuse(load, "it is from " + std::to_string(load.part->from) + " to " +
                       std::to_string(load.part->to) + " m, the rod from 0 to " +
                       std::to_string(length) + " m");
    }
  }
  validate_values(rods, load);
}

/// Calls function(node, share of the node, share of the edge after it) for a load. A node's share
/// of a part is the integral of the function that is 1 there and falls to 0 at the nodes beside it,
/// so that force and moment are those of what is spread over straight edges.
template <class Function>
void for_each_share_of(const Rods& rods, const Loads::Load& load, const Function& function) {
  const std::uint32_t first = rods.first(load.rod);
  const std::uint32_t last = rods.end(load.rod) - 1;
  if (!load.part) {
    const std::uint32_t node = first + load.node;
    const bool is_inside = node > first && node < last;
    if (node > first) {
      function(node - 1, 0.0, is_inside ? 0.5 : 1.0);
    }
    function(node, 1.0, node == last ? 0.0 : is_inside ? 0.5 : 1.0);
    return;
  }
  double begin = 0.0;
  for (std::uint32_t edge = first; edge < last; ++edge) {
    const double length = rods.rest_lengths[edge];
    const double from = std::max(load.part->from - begin, 0.0);
    const double to = std::min(load.part->to - begin, length);
    if (from < to) {
      const double covered = to - from;
      const double after = covered * 0.5 * (from + to) / length;
      function(edge, covered - after, covered);
      function(edge + 1, after, 0.0);
    }
    begin += length;
  }
}

/// The potential of a constant moment on an edge in a step: the part across the edge does the work
/// of turning it about the moment's direction, by an angle that is counted from where the step
/// began. How far the edge leans from the plane across the moment is taken from there, too.
class Couple {
 public:
  Couple(const Vector3d& moment, const Vector3d& start_tangent, const EdgeDirection& edge)
      : axis_(moment.normalized()),
        across_(edge.tangent - axis_ * axis_.dot(edge.tangent)),
        edge_(edge) {
    // An edge along the moment has no side to which it could turn.
    constexpr double min_square = 1e-12;
    const Vector3d start = start_tangent - axis_ * axis_.dot(start_tangent);
    if (start.squaredNorm() > min_square && across_.squaredNorm() > min_square) {
      moment_ = moment.norm() * start.squaredNorm();
      angle_ = signed_angle(start, across_, axis_);
    }
  }

  /// [J]
  double energy() const { return -moment_ * angle_; }

  /// By the edge's second node; by the first it is minus this.
  Vector3d gradient() const {
    return moment_ == 0.0 ? Vector3d(Vector3d::Zero())
                          : Vector3d(-moment_ / (across_.squaredNorm() * edge_.length) *
                                     axis_.cross(edge_.tangent));
  }

 private:
  Vector3d axis_;
  Vector3d across_;  // the tangent's part across the moment
  EdgeDirection edge_;
  double moment_ = 0.0;  // that does work by the angle [N m]
  double angle_ = 0.0;   // since the step began [rad]
};

}  // namespace

std::uint32_t Loads::add(Rods& rods, const Load& load) {
  validate(rods, load);
  const auto id = static_cast<std::uint32_t>(loads_.size());
  loads_.push_back(load);
  for_each_share_of(rods, load, [&](std::uint32_t node, double of_node, double of_edge) {
    rods.masses[node] += of_node * load.mass;
    Share& share = share_of(id, node);
    share.of_force += of_node;
    share.of_torque += of_edge;
  });
  if (!load.part && load.node == 0) {
    share_of(id, rods.first(load.rod)).has_moment = true;
  } else if (!load.part && load.node + 1 == rods.node_count(load.rod)) {
    share_of(id, rods.end(load.rod) - 2).has_moment = true;
  }
  return id;
}

/// The share of this node in a load, which is made if it is not there.
Loads::Share& Loads::share_of(std::uint32_t load, std::uint32_t node) {
  const auto key = std::make_pair(node, load);
  const auto place = std::lower_bound(shares_.begin(), shares_.end(), key,
                                      [](const Share& share, const auto& wanted) {
                                        return std::make_pair(share.node, share.load) < wanted;
                                      });
  if (place != shares_.end() && place->node == node && place->load == load) {
    return *place;
  }
  return *shares_.insert(place, Share{load, node});
}

void Loads::set_force(std::uint32_t load, const Vector3d& force) {
  const TimeTable<Vector3d> table(force);
  require_finite(loads_.at(load), "its force", table);
  loads_[load].force = table;
}

void Loads::set_moment(std::uint32_t load, const Vector3d& moment) {
  const TimeTable<Vector3d> table(moment);
  require_finite(loads_.at(load), "its moment", table);
  loads_[load].moment = table;
}

void Loads::set_torque(std::uint32_t load, double torque) {
  const TimeTable<double> table(torque);
  require_finite(loads_.at(load), "its torque", table);
  loads_[load].torque = table;
}

void Loads::begin_step(Rods& rods, const TimeStep& step) {
  for (Share& share : shares_) {
    const Load& load = loads_[share.load];
    share.force = share.of_force * load.force.at(step.end());
    share.torque = share.of_torque * load.torque.at(step.end());
    if (share.has_moment) {
      share.moment = load.moment.at(step.end());
      share.start_tangent = edge_direction(rods, share.node).tangent;
      // The moment's part along the edge acts on its cross-section, if that resists twist.
      share.along = rods.angles.empty() ? 0.0 : share.moment.dot(share.start_tangent);
    }
  }
}

/// Few nodes are loaded, so that they are visited one after the other.
template <class Visit>
void Loads::for_each_share(const RodPack& rods, const Visit& visit) const {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    const std::uint32_t first = rods.first_nodes[lane];
    const auto begin =
        std::lower_bound(shares_.begin(), shares_.end(), first,
                         [](const Share& share, std::uint32_t node) { return share.node < node; });
    for (auto share = begin; share != shares_.end() && share->node < first + rods.node_count;
         ++share) {
      visit(*share, PackLane(rods, lane), share->node - first);
    }
  }
}

void Loads::energy(const RodPack& rods, const NodeValues& /*values*/, SimdBatch& energy) const {
  energy = SimdBatch{};
  for_each_share(rods, [&](const Share& share, const PackLane& rod, std::uint32_t node) {
    double& sum = energy[rod.lane()];
    sum -= share.force.dot(rod.position(node));
    if (rod.has_twist()) {
      sum -= (share.torque + share.along) * rod.angle(node);
    }
    if (!share.moment.isZero(0.0)) {
      sum += Couple(share.moment, share.start_tangent, rod.direction(node)).energy();
    }
  });
}

void Loads::add_derivatives(const RodPack& rods, const NodeValues& /*values*/,
                            PackSystem& system) const {
  for_each_share(rods, [&](const Share& share, const PackLane& rod, std::uint32_t node) {
    RodSystem rod_system(system, rod.lane());
    rod_system.add_gradient(node, -share.force);
    if (rod.has_twist()) {
      rod_system.add_angle_gradient(node, -share.torque - share.along);
    }
    if (!share.moment.isZero(0.0)) {
      const Vector3d gradient =
          Couple(share.moment, share.start_tangent, rod.direction(node)).gradient();
      rod_system.add_gradient(node, -gradient);
      rod_system.add_gradient(node + 1, gradient);
    }
  });
}

void Loads::add_forces(const RodPack& rods, const NodeValues& /*values*/, RodForces& forces) const {
  for_each_share(rods, [&](const Share& share, const PackLane& rod, std::uint32_t node) {
    Vector3d moment = Vector3d::Zero();
    if (node + 1 < rods.node_count) {
      const Vector3d tangent = rod.direction(node).tangent;
      const double unmet = rod.has_twist() ? 0.0 : share.moment.dot(tangent);
      moment = share.moment + (share.torque - unmet) * tangent;
    }
    if (!share.force.isZero(0.0) || !moment.isZero(0.0)) {
      forces.loads.push_back(
          {share.load, rods.rods[rod.lane()], node, rod.position(node), share.force, moment});
    }
  });
}

}  // namespace fiber
