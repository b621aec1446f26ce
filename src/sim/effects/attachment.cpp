#include "fiber_proximity/sim/effects/attachment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "clamped_end.hpp"
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

std::vector<HeldNode> Attachment::held_at(std::uint32_t rod, double time) const {
  std::vector<HeldNode> nodes;
  for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
    nodes.push_back({held->hold.node, held->hold.placement(time).position});
  }
  return nodes;
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

template <class Visit>
void Attachment::for_each_clamp(std::uint32_t rod, const Visit& visit) const {
  for (auto held = first_of(rod); held != held_.end() && held->hold.rod == rod; ++held) {
    if (held->hold.kind == Kind::CLAMP) {
      visit(*held);
    }
  }
}

double Attachment::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for_each_clamp(rod, [&](const Held& held) {
    energy += ClampedEnd(rods, held.hold, held.placement).energy(held.twist);
    if (!rods.natural_curvature_vectors.empty()) {
      energy += natural_bend(rods, held.hold, held.placement).energy();
    }
  });
  return energy;
}

void Attachment::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  for_each_clamp(rod, [&](const Held& held) {
    ClampedEnd(rods, held.hold, held.placement).add_derivatives(held.twist, system);
    if (!rods.natural_curvature_vectors.empty()) {
      natural_bend(rods, held.hold, held.placement).add_derivatives(system);
    }
  });
}

void Attachment::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                                 Lanes& energy) const {
  energy = Lanes{};
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    for_each_clamp(rods.rods[lane], [&](const Held& held) {
      energy[lane] += ClampedEnd(rods, lane, held.hold, held.placement).energy(held.twist);
    });
  }
}

void Attachment::add_derivatives_in_lanes(const RodLanes& rods,
                                          const std::vector<Lanes>& /*values*/,
                                          LaneSystem& system) const {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    RodSystem of_lane(system, lane);
    for_each_clamp(rods.rods[lane], [&](const Held& held) {
      ClampedEnd(rods, lane, held.hold, held.placement).add_derivatives(held.twist, of_lane);
    });
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
