#include "fiber_proximity/sim/effects/attachment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/edge_pair.hpp"
#include "fiber_proximity/sim/effects/twist.hpp"
#include "natural_bend.hpp"

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

/// Which edge a clamp holds, from the rod's first one.
std::uint32_t clamped_edge(const Attachment::Hold& hold) {
  return hold.node == 0 ? 0 : hold.node - 1;
}

/// How the end of a rod is bent against the clamp that holds it.
struct ClampedBend {
  std::uint32_t edge;
  EdgeDirection direction;
  Vector3d turn;
  double stiffness;

  ClampedBend(const Attachment::Hold& hold, const Placement& placement,
              const EdgeDirection& direction_of_edge, double rest_length, double bending_stiffness)
      : edge(clamped_edge(hold)),
        direction(direction_of_edge),
        turn(direction.tangent - placement.tangent),
        stiffness(bending_stiffness / (0.5 * rest_length)) {}

  ClampedBend(const Rods& rods, const Attachment::Hold& hold, const Placement& placement)
      : ClampedBend(hold, placement,
                    edge_direction(rods, rods.first(hold.rod) + clamped_edge(hold)),
                    rods.rest_lengths[rods.first(hold.rod) + clamped_edge(hold)],
                    rods.sections[hold.rod].bending_stiffness) {}

  ClampedBend(const RodLanes& rods, std::size_t lane, const Attachment::Hold& hold,
              const Placement& placement)
      : ClampedBend(hold, placement, direction_in_lane(rods, lane, clamped_edge(hold)),
                    rods.rest_lengths[clamped_edge(hold)][lane], rods.bending_stiffness[lane]) {}

  double energy() const { return 0.5 * stiffness * turn.squaredNorm(); }

  void add_derivatives(RodSystem& system) const {
    const Eigen::Matrix3d across =
        (Eigen::Matrix3d::Identity() - direction.tangent * direction.tangent.transpose()) /
        direction.length;
    const Vector3d gradient = stiffness * (across * turn);
    const Eigen::Matrix3d block = stiffness / direction.length * across;
    system.add_edge(edge, gradient, block);
  }

 private:
  static EdgeDirection direction_in_lane(const RodLanes& rods, std::size_t lane,
                                         std::uint32_t edge) {
    const Lanes* const tangent = &rods.tangents[std::size_t{3} * edge];
    return {rods.lengths[edge][lane], {tangent[0][lane], tangent[1][lane], tangent[2][lane]}};
  }
};

/// The end of a rod with twist that a clamp holds, and how the clamp looks from there.
class ClampedEnd {
 public:
  ClampedEnd(const Rods& rods, const Attachment::Hold& hold, const Placement& placement)
      : rods_(rods),
        rod_(hold.rod),
        edge_(rods.first(rod_) + clamped_edge(hold)),
        direction_(edge_direction(rods, edge_)),
        placement_(placement) {}

  /// The index of the edge from the rod's first one.
  std::uint32_t edge() const { return edge_ - rods_.first(rod_); }

  double twisting() const {
    return rods_.sections[rod_].twisting_stiffness / (0.5 * rods_.rest_lengths[edge_]);
  }

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
  const Rods& rods_;
  std::uint32_t rod_;
  std::uint32_t edge_;
  EdgeDirection direction_;
  const Placement& placement_;
};

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

/// How a rod with natural curvature is bent against the clamp that holds it.
NaturalBend natural_bend(const Rods& rods, const Attachment::Hold& hold,
                         const Placement& placement) {
  return NaturalBend::at_clamp(
      rods, hold.rod, hold.node,
      {placement.tangent, placement.director, placement.tangent.cross(placement.director)});
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
  solving_for_ = step.end();
  for (Held& held : held_) {
    held.placement = held.hold.placement(step.end());
    validate(rods, held.hold, held.placement);
    rods.held.push_back({rods.first(held.hold.rod) + held.hold.node, held.placement.position});
  }
}

void Attachment::end_solve(const Rods& /*rods*/, std::uint32_t rod) {
  const auto first = held_.begin() + (first_of(rod) - held_.cbegin());
  for (auto held = first; held != held_.end() && held->hold.rod == rod; ++held) {
    held->solved_at = solving_for_;
    held->solved_position = held->placement.position;
  }
}

void Attachment::place_at_end(Rods& rods, Held& held, const TimeStep& step) const {
  held.placement = held.hold.placement(step.end());
  validate(rods, held.hold, held.placement);
  const std::uint32_t node = rods.first(held.hold.rod) + held.hold.node;
  rods.positions[node] = held.placement.position;
  rods.velocities[node] =
      (held.placement.position - held.solved_position) / (step.end() - held.solved_at);
}

std::vector<Attachment::Held>::const_iterator Attachment::first_of(std::uint32_t rod) const {
  return std::lower_bound(held_.begin(), held_.end(), rod,
                          [](const Held& held, std::uint32_t r) { return held.hold.rod < r; });
}

double Attachment::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
    if (held->hold.kind == Kind::CLAMP) {
      energy += rods.natural_curvature_vectors.empty()
                    ? ClampedBend(rods, held->hold, held->placement).energy()
                    : natural_bend(rods, held->hold, held->placement).energy();
      if (!rods.directors.empty()) {
        const ClampedEnd end(rods, held->hold, held->placement);
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
      if (rods.natural_curvature_vectors.empty()) {
        ClampedBend(rods, held->hold, held->placement).add_derivatives(system);
      } else {
        natural_bend(rods, held->hold, held->placement).add_derivatives(system);
      }
      if (!rods.directors.empty()) {
        const ClampedEnd end(rods, held->hold, held->placement);
        add_twisting(end, end.twist(held->twist), system);
      }
    }
  }
}

void Attachment::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                                 Lanes& energy) const {
  energy = Lanes{};
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    const std::uint32_t rod = rods.rods[lane];
    for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
      if (held->hold.kind == Kind::CLAMP) {
        energy[lane] += ClampedBend(rods, lane, held->hold, held->placement).energy();
      }
    }
  }
}

void Attachment::add_derivatives_in_lanes(const RodLanes& rods,
                                          const std::vector<Lanes>& /*values*/,
                                          LaneSystem& system) const {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    const std::uint32_t rod = rods.rods[lane];
    for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
      if (held->hold.kind == Kind::CLAMP) {
        RodSystem of_lane(system, lane);
        ClampedBend(rods, lane, held->hold, held->placement).add_derivatives(of_lane);
      }
    }
  }
}

void Attachment::end_step(Rods& rods, const TimeStep& step) {
  const bool has_twist = !rods.directors.empty();
  for (Held& held : held_) {
    if (step.end() != held.solved_at) {
      place_at_end(rods, held, step);
    }
    if (has_twist && held.hold.kind == Kind::CLAMP) {
      held.twist = ClampedEnd(rods, held.hold, held.placement).twist(held.twist);
    }
  }
}

}  // namespace fiber
