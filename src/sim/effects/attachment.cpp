#include "fiber_proximity/sim/attachment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/effects/clamped_end.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

bool is_unit(const Vector3d& v) { return std::abs(v.norm() - 1.0) < 1e-6; }

[[noreturn]] void refuse(const Attachment::Hold& hold, const std::string& problem) {
  throw std::invalid_argument("attachment: hold on node " + std::to_string(hold.node) + " of rod " +
                              std::to_string(hold.rod) + ": " + problem);
}

void validate(const Rods& rods, const Attachment::Hold& hold) {
  if (hold.rod >= rods.count()) {
    refuse(hold, "there are " + std::to_string(rods.count()) + " rods");
  }
  const std::uint32_t count = rods.node_count(hold.rod);
  if (hold.node >= count) {
    refuse(hold, "the rod has " + std::to_string(count) + " nodes");
  }
  if (hold.kind == Attachment::Kind::CLAMP &&
      (rods.is_closed(hold.rod) || (hold.node != 0 && hold.node + 1 != count))) {
    refuse(hold, "a clamp must be at an end of the rod");
  }
  if (!hold.placement) {
    refuse(hold, "it has no placement");
  }
  if (!(std::isfinite(hold.max_force) && hold.max_force >= 0.0)) {
    refuse(hold, "its greatest force is " + std::to_string(hold.max_force) +
                     " N, it must be at least 0 and finite");
  }
}

void validate(const Rods& rods, const Attachment::Hold& hold, const Placement& placement) {
  if (!placement.position.allFinite()) {
    refuse(hold, "its position must be finite");
  }
  if (hold.kind == Attachment::Kind::PIN) {
    return;
  }
  if (!is_unit(placement.tangent)) {
    refuse(hold, "a clamp's tangent must be of unit length");
  }
  if (!rods.directors.empty() && (!is_unit(placement.director) ||
                                  std::abs(placement.director.dot(placement.tangent)) > 1e-6)) {
    refuse(hold, "a clamp's director must be of unit length and across its tangent");
  }
}

double twist_of(const Rods& rods, const Attachment::Hold& hold, const Placement& clamp,
                double near) {
  const std::uint32_t edge = rods.first(hold.rod) + clamped_edge(hold.node);
  return twist_of(clamp, edge_direction(rods, edge).tangent, current_director(rods, edge),
                  rods.angles[edge], near);
}

}  // namespace

/// The force on the node.
Vector3d Attachment::Held::pull_at(const Vector3d& position) const {
  const Vector3d way = placement.position - position;
  const double distance = way.norm();
  return stiffness * distance > max_force ? Vector3d(max_force / distance * way)
                                          : Vector3d(stiffness * way);
}

std::uint32_t Attachment::add(const Rods& rods, const Hold& hold) {
  validate(rods, hold);
  Held held{next_id_, hold, hold.max_force, 0.0, hold.placement(0.0)};
  validate(rods, hold, held.placement);
  const auto is_before = [](const Held& a, const Hold& b) {
    return std::make_pair(a.hold.rod, a.hold.node) < std::make_pair(b.rod, b.node);
  };
  const auto place = std::lower_bound(held_.begin(), held_.end(), hold, is_before);
  if (place != held_.end() && place->hold.rod == hold.rod && place->hold.node == hold.node) {
    refuse(hold, "it is held already");
  }
  if (hold.max_force == 0.0) {
    held.max_force = default_strain * rods.sections[hold.rod].stretching_stiffness;
  }
  if (held.is_clamp() && !rods.directors.empty()) {
    held.twist = twist_of(rods, hold, held.placement, 0.0);
  }
  held_.insert(place, held);
  return next_id_++;
}

std::optional<std::uint32_t> Attachment::find(std::uint32_t rod, std::uint32_t node) const {
  for (const Held& held : held_) {
    if (held.hold.rod == rod && held.hold.node == node) {
      return held.id;
    }
  }
  return std::nullopt;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> Attachment::held_nodes() const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> nodes;
  for (const Held& held : held_) {
    nodes.emplace_back(held.hold.rod, held.hold.node);
  }
  return nodes;
}

std::optional<HoldLag> Attachment::longest_lag(const Rods& rods) const {
  std::optional<HoldLag> longest;
  for (const Held& held : held_) {
    const Vector3d& node = rods.positions[rods.first(held.hold.rod) + held.hold.node];
    const double distance = (held.placement.position - node).norm();
    if (held.stiffness * distance > held.max_force && (!longest || distance > longest->distance)) {
      longest = HoldLag{held.hold.rod, held.hold.node, distance, held.max_force};
    }
  }
  return longest;
}

std::vector<HeldNode> Attachment::held_at(std::uint32_t rod, double time) const {
  std::vector<HeldNode> nodes;
  for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
    nodes.push_back({held->hold.node, held->hold.placement(time).position});
  }
  return nodes;
}

std::vector<Attachment::Held>::const_iterator Attachment::by_id(std::uint32_t id) const {
  const auto place =
      std::find_if(held_.begin(), held_.end(), [id](const Held& held) { return held.id == id; });
  if (place == held_.end()) {
    throw std::invalid_argument("attachment: there is no hold " + std::to_string(id));
  }
  return place;
}

void Attachment::redirect(std::uint32_t id, std::function<Placement(double time)> placement) {
  const auto index = by_id(id) - held_.cbegin();
  held_[static_cast<std::size_t>(index)].hold.placement = std::move(placement);
}

Placement Attachment::placement(std::uint32_t id, double time) const {
  return by_id(id)->hold.placement(time);
}

void Attachment::remove(std::uint32_t id) { held_.erase(by_id(id)); }

void Attachment::take_state(const Effect& other) {
  const auto& attachment = static_cast<const Attachment&>(other);
  held_ = attachment.held_;
  next_id_ = attachment.next_id_;
}

void Attachment::begin_step(Rods& rods, const TimeStep& step) {
  constexpr double ratio = 1000.0;  // to the rod's edges and the node's inertia
  for (Held& held : held_) {
    held.placement = held.hold.placement(step.end());
    validate(rods, held.hold, held.placement);
    const std::uint32_t node = rods.first(held.hold.rod) + held.hold.node;
    const std::uint32_t edge = std::min(node, rods.end(held.hold.rod) - 2);
    const double edge_stiffness = rods.edge_stiffness(held.hold.rod, edge);
    held.stiffness = ratio * (edge_stiffness + rods.masses[node] / (step.length * step.length));
    held.natural_bend.reset();
    if (held.is_clamp() && !rods.natural_curvature_vectors.empty()) {
      held.natural_bend = rods.natural_curvature_vectors[node];
    }
    if (held.is_clamp() && !rods.stiff_sides.empty()) {
      held.stiff_side = rods.stiff_sides[node];
    }
  }
}

bool Attachment::holds(std::uint32_t rod) const {
  const auto held = first_of(rod);
  return held != held_.end() && held->hold.rod == rod;
}

std::vector<Attachment::Held>::const_iterator Attachment::first_of(std::uint32_t rod) const {
  return std::lower_bound(held_.begin(), held_.end(), rod,
                          [](const Held& held, std::uint32_t r) { return held.hold.rod < r; });
}

/// Few nodes are held, so that they are visited one after the other.
template <class Visit>
void Attachment::for_each_held(const RodPack& rods, const Visit& visit) const {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    const std::uint32_t rod = rods.rods[lane];
    for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
      visit(*held, PackLane(rods, lane));
    }
  }
}

void Attachment::energy(const RodPack& rods, const NodeValues& /*values*/,
                        SimdBatch& energy) const {
  energy = SimdBatch{};
  for_each_held(rods, [&](const Held& held, const PackLane& rod) {
    const std::uint32_t node = held.hold.node;
    const double distance = (held.placement.position - rod.position(node)).norm();
    const double within = std::min(distance, held.max_force / held.stiffness);
    energy[rod.lane()] += held.stiffness * within * (distance - 0.5 * within);
    if (held.is_clamp()) {
      ClampedEnd(rod, node, held.placement, held.twist, {held.natural_bend, held.stiff_side})
          .add_energy(energy[rod.lane()]);
    }
  });
}

void Attachment::add_derivatives(const RodPack& rods, const NodeValues& /*values*/,
                                 PackSystem& system) const {
  for_each_held(rods, [&](const Held& held, const PackLane& rod) {
    RodSystem rod_system(system, rod.lane());
    const std::uint32_t node = held.hold.node;
    const Vector3d pull = held.pull_at(rod.position(node));
    const double distance = (held.placement.position - rod.position(node)).norm();
    // The Hessian of a constant force vanishes along it. With this stiffness, Newton's step leads
    // to the hold, not far beyond it.
    const double stiffness = std::min(held.stiffness, held.max_force / distance);
    rod_system.add_gradient(node, -pull);
    rod_system.add_hessian(node, stiffness * Eigen::Matrix3d::Identity());
    if (held.is_clamp()) {
      ClampedEnd(rod, node, held.placement, held.twist, {held.natural_bend, held.stiff_side})
          .add_derivatives(rod_system);
    }
  });
}

void Attachment::end_step(Rods& rods, const TimeStep& /*step*/) {
  for (Held& held : held_) {
    if (held.is_clamp() && !rods.directors.empty()) {
      held.twist = twist_of(rods, held.hold, held.placement, held.twist);
    }
  }
}

void Attachment::add_forces(const RodPack& rods, const NodeValues& /*values*/,
                            RodForces& forces) const {
  for_each_held(rods, [&](const Held& held, const PackLane& rod) {
    const std::uint32_t node = held.hold.node;
    const Vector3d point = rod.position(node);
    const Vector3d moment = held.is_clamp() ? ClampedEnd(rod, node, held.placement, held.twist,
                                                         {held.natural_bend, held.stiff_side})
                                                  .moment()
                                            : Vector3d(Vector3d::Zero());
    forces.holds.push_back({held.id, held.hold.rod, node, point, held.pull_at(point), moment,
                            (held.placement.position - point).norm(), held.max_force});
  });
}

}  // namespace fiber
