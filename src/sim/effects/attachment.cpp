#include "fiber_proximity/sim/effects/attachment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/edge_pair.hpp"
#include "fiber_proximity/sim/effects/twist.hpp"

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
  if (hold.kind == Attachment::Kind::CLAMP && hold.node != 0 && hold.node + 1 != count) {
    refuse(hold, "a clamp must be at an end of the rod");
  }
  if (!hold.placement) {
    refuse(hold, "it has no placement");
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

/// The end of a rod that a clamp holds, and how the clamp looks from there.
class ClampedEnd {
 public:
  ClampedEnd(const Rods& rods, const Attachment::Hold& hold, const Placement& placement)
      : rods_(rods),
        rod_(hold.rod),
        is_first_(hold.node == 0),
        edge_(is_first_ ? rods.first(rod_) : rods.end(rod_) - 2),
        direction_(edge_direction(rods, edge_)),
        placement_(placement) {}

  /// The index of the edge from the rod's first one.
  std::uint32_t edge() const { return edge_ - rods_.first(rod_); }
  const EdgeDirection& direction() const { return direction_; }

  Vector3d turn() const { return direction_.tangent - placement_.tangent; }
  double bending() const { return rods_.sections[rod_].bending_stiffness / length(); }
  double twisting() const { return rods_.sections[rod_].twisting_stiffness / length(); }

  /// From the clamp to the cross-section of the edge [rad], by whole turns near another.
  double twist(double near) const {
    const Vector3d carried = transport(placement_.director, placement_.tangent, direction_.tangent);
    const double reference =
        signed_angle(carried, current_director(rods_, edge_), direction_.tangent);
    return nearest_turn(rods_.angles[edge_] + reference, near);
  }

  /// The derivative of that by the edge's second node; by the first minus this.
  Vector3d twist_derivative() const {
    return director_turn(rods_, edge_) +
           curvature_binormal(placement_.tangent, direction_.tangent) / (2.0 * direction_.length);
  }

 private:
  double length() const { return 0.5 * rods_.rest_lengths[edge_]; }

  const Rods& rods_;
  std::uint32_t rod_;
  bool is_first_;
  std::uint32_t edge_;
  EdgeDirection direction_;
  const Placement& placement_;
};

void add_bending(const ClampedEnd& end, RodSystem& system) {
  const EdgeDirection& edge = end.direction();
  const double stiffness = end.bending();
  const Eigen::Matrix3d across =
      (Eigen::Matrix3d::Identity() - edge.tangent * edge.tangent.transpose()) / edge.length;
  const Vector3d gradient = stiffness * (across * end.turn());
  const Eigen::Matrix3d block = stiffness / edge.length * across;
  system.add_edge(end.edge(), gradient, block);
}

void add_twisting(const ClampedEnd& end, double twist, RodSystem& system) {
  const double stiffness = end.twisting();
  const Vector3d derivative = end.twist_derivative();
  system.add_gradient(end.edge(), -stiffness * twist * derivative);
  system.add_gradient(end.edge() + 1, stiffness * twist * derivative);
  system.add_angle_gradient(end.edge(), stiffness * twist);
  Eigen::Matrix<double, 7, 1> by_all;
  by_all << -derivative, 1.0, derivative;
  const std::size_t start = std::size_t{end.edge()} * system.unknowns();
  for (Eigen::Index c = 0; c < by_all.size(); ++c) {
    for (Eigen::Index r = c; r < by_all.size(); ++r) {
      system.add_hessian_entry(start + r, start + c, stiffness * by_all[r] * by_all[c]);
    }
  }
}

}  // namespace

std::uint32_t Attachment::add(const Rods& rods, const Hold& hold) {
  validate(rods, hold);
  Held held{next_id_, hold, hold.placement(0.0)};
  validate(rods, hold, held.placement);
  const auto is_before = [](const Held& a, const Hold& b) {
    return std::make_pair(a.hold.rod, a.hold.node) < std::make_pair(b.rod, b.node);
  };
  const auto place = std::lower_bound(held_.begin(), held_.end(), hold, is_before);
  if (place != held_.end() && place->hold.rod == hold.rod && place->hold.node == hold.node) {
    refuse(hold, "it is held already");
  }
  if (hold.kind == Kind::CLAMP && !rods.directors.empty()) {
    held.twist = ClampedEnd(rods, hold, held.placement).twist(0.0);
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

void Attachment::remove(std::uint32_t id) {
  const auto place =
      std::find_if(held_.begin(), held_.end(), [id](const Held& held) { return held.id == id; });
  if (place == held_.end()) {
    throw std::invalid_argument("attachment: there is no hold " + std::to_string(id));
  }
  held_.erase(place);
}

void Attachment::begin_step(Rods& rods, const TimeStep& step) {
  rods.held.clear();
  placed_at_ = step.end();
  for (Held& held : held_) {
    held.placement = held.hold.placement(step.end());
    validate(rods, held.hold, held.placement);
    rods.held.push_back({rods.first(held.hold.rod) + held.hold.node, held.placement.position});
  }
}

void Attachment::place_at_end(Rods& rods, Held& held, const TimeStep& step) const {
  const Vector3d middle = held.placement.position;
  held.placement = held.hold.placement(step.end());
  validate(rods, held.hold, held.placement);
  const std::uint32_t node = rods.first(held.hold.rod) + held.hold.node;
  rods.positions[node] = held.placement.position;
  rods.velocities[node] = (held.placement.position - middle) / (step.end() - placed_at_);
}

std::vector<Attachment::Held>::const_iterator Attachment::first_of(std::uint32_t rod) const {
  return std::lower_bound(held_.begin(), held_.end(), rod,
                          [](const Held& held, std::uint32_t r) { return held.hold.rod < r; });
}

double Attachment::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
    if (held->hold.kind == Kind::CLAMP) {
      const ClampedEnd end(rods, held->hold, held->placement);
      energy += 0.5 * end.bending() * end.turn().squaredNorm();
      if (!rods.directors.empty()) {
        const double twist = end.twist(held->twist);
        energy += 0.5 * end.twisting() * twist * twist;
      }
    }
  }
  return energy;
}

void Attachment::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
    if (held->hold.kind == Kind::CLAMP) {
      const ClampedEnd end(rods, held->hold, held->placement);
      add_bending(end, system);
      if (!rods.directors.empty()) {
        add_twisting(end, end.twist(held->twist), system);
      }
    }
  }
}

void Attachment::end_step(Rods& rods, const TimeStep& step) {
  const bool has_twist = !rods.directors.empty();
  for (Held& held : held_) {
    if (step.end() != placed_at_) {
      place_at_end(rods, held, step);
    }
    if (has_twist && held.hold.kind == Kind::CLAMP) {
      held.twist = ClampedEnd(rods, held.hold, held.placement).twist(held.twist);
    }
  }
}

}  // namespace fiber
