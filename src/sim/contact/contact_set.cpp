#include "src/sim/contact/contact_set.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Contacts are numbered: first those with obstacles, then those of pairs, then those with friction,
// then those with midpoint normals. Threads take them in chunks, which do not depend on the number
// of threads.
constexpr std::size_t chunk = 64;

std::size_t chunk_count(std::size_t count) { return (count + chunk - 1) / chunk; }

/// Calls function(chunk, begin, end) in parallel.
template <class Function>
void for_each_chunk(std::size_t count, const Function& function) {
  tbb::parallel_for(std::size_t{0}, chunk_count(count), [&](std::size_t index) {
    function(index, index * chunk, std::min(count, (index + 1) * chunk));
  });
}

}  // namespace

void ContactSet::clear() {
  pairs.clear();
  obstacle_contacts.clear();
  obstacle_edges.clear();
  was_near_.clear();
  frictions_.clear();
  midpoint_forces_.clear();
  impacts_.clear();
  has_motion_ = false;
  for (ContactDerivatives& derivatives : terms_) {
    derivatives.clear();
  }
}

void ContactSet::begin(const Rods& rods, const Friction* friction, const FrictionOrigins& origins,
                       double step) {
  frictions_.clear();
  midpoint_forces_.clear();
  friction_ = friction;
  origins_ = origins;
  step_ = step;
  update_distances(rods);
  relax_initial_overlap(rods);
  impacts_.clear();
  was_near_.clear();
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    was_near_.push_back(obstacle_distances_[i].nearest.distance <
                        obstacle_contacts[i].barrier.outer);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    was_near_.push_back(distances_[i].distance < pairs[i].barrier.outer);
  }
  if (friction != nullptr) {
    stick_length_ = friction->stick_length(step);
    anchors_.assign(distance_count(), std::nullopt);
    add_friction(rods, [](std::uint32_t /*rod*/) { return 1.0; });
  }
}

namespace {

/// Has slips measured against an obstacle that moves, and the slip from before turn with it.
/// @param reference where the slip is nil
void move_reference(const MovedShapes& moved, const Rods& rods, const ContactPoints& points,
                    const std::optional<SurfaceLevers>& levers, Vector3d& reference,
                    Vector3d& slip) {
  if (const MovedShape* const shape = moved.of_object(points)) {
    Vector3d point = point_at(rods.positions, points.edge_a, points.s);
    if (levers) {
      point += levers->front().arm;
    }
    reference += shape->displacement(point);
    slip = shape->turned(slip);
  }
}

}  // namespace

/// Adds the friction by the normal forces at the current distances.
/// @param share_of of the first rod of a contact: see update_friction()
template <class ShareOf>
void ContactSet::add_friction(const Rods& rods, const ShareOf& share_of) {
  by_chunk_.resize(std::max(by_chunk_.size(), chunk_count(distance_count())));
  for_each_chunk(distance_count(), [&](std::size_t index, std::size_t begin, std::size_t end) {
    DistanceTerms buffer;
    by_chunk_[index].clear();
    for (std::size_t i = begin; i < end; ++i) {
      const double share = share_of(rods_of(i).first);
      if (share == 0.0) {
        continue;
      }
      double scale = 1.0;
      if (share < 1.0) {
        double now = 0.0;
        for_each_term(rods, i, buffer, [&](const ContactPoints& /*points*/, const auto& term) {
          now += friction_->coefficient() * std::max(0.0, term.pressure);
        });
        scale = now > 0.0 ? share + (1.0 - share) * max_forces_before_[i] / now : 1.0;
      }
      for_each_term(rods, i, buffer, [&](const ContactPoints& points, const DistanceTerm& term) {
        if (term.pressure > 0.0) {
          Vector3d reference = difference_of_points(origins_.state->positions, points);
          const auto levers = surface_levers(rods, points, term.normal);
          if (levers) {
            reference +=
                lever_motion(*levers, points, origins_.state->positions, origins_.state->angles);
          }
          const double max_force = scale * friction_->coefficient() * term.pressure;
          if (!anchors_[i]) {
            anchors_[i] = origins_.anchors->nearest(points, term.normal);
          }
          const FrictionAnchors::Anchor* const anchor = *anchors_[i];
          Vector3d slip = anchor != nullptr
                              ? FrictionAnchors::slip_from(*anchor, max_force, stick_length_)
                              : Vector3d::Zero();
          if (has_motion_) {
            move_reference(*moved_, rods, points, levers, reference, slip);
          }
          reference -= slip;
          by_chunk_[index].push_back({i, points, term.normal, max_force, reference, levers});
        }
      });
    }
  });
  for (std::size_t i = 0; i < chunk_count(distance_count()); ++i) {
    frictions_.insert(frictions_.end(), by_chunk_[i].begin(), by_chunk_[i].end());
  }
}

void ContactSet::update_friction(const Rods& rods, const std::vector<std::uint32_t>& islands,
                                 const std::vector<double>& shares) {
  if (friction_ == nullptr ||
      std::all_of(shares.begin(), shares.end(), [](double share) { return share == 0.0; })) {
    return;
  }
  const auto share_of = [&](std::uint32_t rod) { return shares[islands[rod]]; };
  max_forces_before_.assign(distance_count(), 0.0);
  for (const ResistedPoint& point : frictions_) {
    max_forces_before_[point.contact] += point.max_force;
  }
  frictions_.erase(std::remove_if(frictions_.begin(), frictions_.end(),
                                  [&](const ResistedPoint& point) {
                                    return share_of(point.points.rod_a) > 0.0;
                                  }),
                   frictions_.end());
  add_friction(rods, share_of);
  evaluate_energies(rods, distance_count());
}

void ContactSet::add_anchors(const Rods& rods, FrictionAnchors& anchors) const {
  for (const ResistedPoint& point : frictions_) {
    const Vector3d slip = point.slip(rods);
    const double length = slip.norm();
    anchors.add({point.points, point.normal, slip / std::max(length, stick_length_),
                 point.stored_energy(length, stick_length_)});
  }
}

/// Contacts that begin the step where their energy is infinite get barriers that begin nearer.
void ContactSet::relax_initial_overlap(const Rods& rods) {
  const auto relax = [&](std::size_t contact, double distance, Barrier& barrier) {
    // Effective distances are not below the distance, but for rounding.
    const double rounding = 1e-6 * barrier.width();
    if (!(distance > barrier.inner + rounding) && !std::isfinite(energy_of(rods, contact))) {
      barrier = barrier.relaxed_to(distance);
    }
  };
  std::size_t contact = 0;
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    relax(contact++, obstacle_distances_[i].nearest.distance, obstacle_contacts[i].barrier);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    relax(contact++, distances_[i].distance, pairs[i].barrier);
  }
}

void ContactSet::update_distances(const Rods& rods) {
  obstacle_distances_.resize(obstacle_contacts.size());
  for_each_chunk(
      obstacle_contacts.size(), [&](std::size_t /*index*/, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          obstacle_distances_[i] = obstacle_distance(obstacle_contacts[i], rods.positions);
        }
      });
  distances_.resize(pairs.size());
  for_each_chunk(pairs.size(), [&](std::size_t /*index*/, std::size_t begin, std::size_t end) {
    std::array<const Vector3d*, chunk> a{};
    std::array<const Vector3d*, chunk> b{};
    for (std::size_t i = begin; i < end; ++i) {
      a[i - begin] = &rods.positions[pairs[i].edge_a];
      b[i - begin] = &rods.positions[pairs[i].edge_b];
    }
    segment_distances(a.data(), b.data(), end - begin, &distances_[begin]);
  });
}

Vector3d ContactSet::ResistedPoint::slip(const Rods& rods) const {
  Vector3d moved = point_at(rods.positions, points.edge_a, points.s) - reference;
  if (points.is_of_rods()) {
    moved -= point_at(rods.positions, points.edge_b, points.t);
  }
  if (levers) {
    moved += lever_motion(*levers, points, rods.positions, rods.angles);
  }
  return moved - normal * normal.dot(moved);
}

Vector3d ContactSet::ResistedPoint::force(const Rods& rods, double stick_length) const {
  const Vector3d slipped = slip(rods);
  return -law(slipped.norm(), stick_length).resistance * slipped;
}

Friction::Law ContactSet::ResistedPoint::law(double slip, double stick_length) const {
  if (viscosity > 0.0) {
    return {0.5 * viscosity * slip * slip, viscosity, viscosity};
  }
  const Friction::Law unit = Friction::law(slip, stick_length);
  return {max_force * unit.energy, max_force * unit.resistance, max_force * unit.curvature};
}

/// The point of a contact with friction or a midpoint normal.
const ContactSet::ResistedPoint& ContactSet::resisted_point(std::size_t contact) const {
  contact -= distance_count();
  return contact < frictions_.size() ? frictions_[contact]
                                     : midpoint_forces_[contact - frictions_.size()];
}

double ContactSet::energy_of(const Rods& rods, std::size_t contact) const {
  if (contact < obstacle_contacts.size()) {
    return obstacle_contact(obstacle_contacts[contact], obstacle_distances_[contact], nullptr);
  }
  if (contact < distance_count()) {
    const std::size_t pair = contact - obstacle_contacts.size();
    return edge_contact(pairs[pair], rods.positions, distances_[pair], nullptr);
  }
  const ResistedPoint& point = resisted_point(contact);
  return point.law(point.slip(rods).norm(), stick_length_).energy;
}

/// Those from the first one asked for.
void ContactSet::evaluate_energies(const Rods& rods, std::size_t first) {
  energies_.resize(contact_count());
  for_each_chunk(energies_.size() - first,
                 [&](std::size_t /*index*/, std::size_t begin, std::size_t end) {
                   for (std::size_t i = first + begin; i < first + end; ++i) {
                     energies_[i] = energy_of(rods, i);
                   }
                 });
}

void ContactSet::add_energies(const std::vector<std::uint32_t>& islands,
                              std::vector<EnergySum>& energies) const {
  for (std::size_t i = 0; i < energies_.size(); ++i) {
    energies[islands[rods_of(i).first]].add(energies_[i]);
  }
}

/// The two rods of a contact; with an obstacle, one rod twice.
std::pair<std::uint32_t, std::uint32_t> ContactSet::rods_of(std::size_t contact) const {
  if (contact < obstacle_contacts.size()) {
    return {obstacle_contacts[contact].rod, obstacle_contacts[contact].rod};
  }
  if (contact < distance_count()) {
    const EdgePair& pair = pairs[contact - obstacle_contacts.size()];
    return {pair.rod_a, pair.rod_b};
  }
  const ContactPoints& points = resisted_point(contact).points;
  return {points.rod_a, points.is_of_rods() ? points.rod_b : points.rod_a};
}

void ContactSet::add_stored_energies(const std::vector<std::uint32_t>& islands,
                                     std::vector<double>& energies) const {
  for (std::size_t i = 0; i < distance_count(); ++i) {
    energies[islands[rods_of(i).first]] += energies_[i];
  }
}

double ContactSet::stored_energy() const {
  const auto end = energies_.begin() + static_cast<std::ptrdiff_t>(distance_count());
  return std::accumulate(energies_.begin(), end, 0.0);
}

void ContactSet::find_derivatives(const Rods& rods) {
  terms_.resize(std::max(terms_.size(), chunk_count(contact_count())));
  std::for_each(terms_.begin(), terms_.end(), [](auto& derivatives) { derivatives.clear(); });
  for_each_chunk(contact_count(), [&](std::size_t index, std::size_t begin, std::size_t end) {
    DistanceTerms found;
    for (std::size_t i = begin; i < end; ++i) {
      find_terms(rods, i, found, terms_[index]);
    }
  });
  if (has_motion_) {
    add_terms_of_motion(rods);
  }
}

}  // namespace fiber
