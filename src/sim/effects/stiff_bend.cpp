#include "src/sim/effects/stiff_bend.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/text/with_context.hpp"

namespace fiber {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

Vector3d towards(const CrossSection& section, const StiffSide& side) {
  return side.side.x() * section.first + side.side.y() * section.second;
}

}  // namespace

StiffBend::StiffBend(const PackLane& rod, std::uint32_t node, const StiffSide& side, double rest,
                     const CrossSection& before, const CrossSection& after)
    : rod_(rod), node_(node), stiffness_(side.stiffness) {
  const Vector3d side_before = towards(before, side);
  const Vector3d side_after = towards(after, side);
  residual_ = strain(side, before, after) - rest;
  by_rotation_ = 0.5 * (side_before.cross(after.tangent) + side_after.cross(before.tangent));
}

double StiffBend::strain(const StiffSide& side, const CrossSection& before,
                         const CrossSection& after) {
  return 0.5 *
         (after.tangent.dot(towards(before, side)) - before.tangent.dot(towards(after, side)));
}

double StiffBend::rest(const StiffSide& side, const Vector2d& curvature, double length) {
  const double size = curvature.norm();
  return size > 0.0 ? std::sin(std::min(size * length, M_PI)) / size * curvature.dot(side.side)
                    : 0.0;
}

StiffBend StiffBend::at_node(const PackLane& rod, std::uint32_t node, const StiffSide& side,
                             double rest) {
  return {rod, node, side, rest, cross_section(rod, node - 1), cross_section(rod, node)};
}

StiffBend StiffBend::at_clamp(const PackLane& rod, std::uint32_t node, const StiffSide& side,
                              double rest, const CrossSection& clamp) {
  const CrossSection end = cross_section(rod, node == 0 ? 0 : node - 1);
  return {rod, node, side, rest, node == 0 ? clamp : end, node == 0 ? end : clamp};
}

void StiffBend::add_derivatives(RodSystem& system) const {
  const bool has_before = node_ > 0;
  const bool has_after = node_ + 1 < rod_.node_count();
  // By all unknowns of the one or two edges.
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 11> by_all;
  by_all.setZero(1, has_before && has_after ? 11 : 7);
  if (has_before) {
    by_all.leftCols<7>() += by_rotation_.transpose() * rotation_by_edge(rod_, node_ - 1);
  }
  if (has_after) {
    by_all.rightCols<7>() -= by_rotation_.transpose() * rotation_by_edge(rod_, node_);
  }
  const Eigen::Matrix<double, 1, 1> residual(residual_);
  add_square(has_before ? node_ - 1 : node_, stiffness_, residual, by_all, system);
}

void Rods::set_stiff_side(std::uint32_t rod, const Vector3d& towards) {
  const std::string place = "rod " + std::to_string(rod) + ": stiff side";
  if (directors.empty()) {
    throw std::invalid_argument(place + ": cross-sections have no side without twist");
  }
  const Vector2d side = with_context(place, [&] { return side_towards(*this, rod, towards); });
  stiff_sides.resize(positions.size());
  const RodSection& own = sections[rod];
  for (std::uint32_t i = first(rod); i < end(rod); ++i) {
    const double before = i > first(rod) ? rest_lengths[i - 1] : 0.0;
    const double after = i + 1 < end(rod) ? rest_lengths[i] : 0.0;
    const double soft =
        section_lengths.empty() ? 0.5 * (before + after) : section_lengths.bending[i];
    const double stiff =
        section_lengths.empty() ? soft / own.bending_ratio : section_lengths.stiff[i];
    stiff_sides[i] = {own.bending_stiffness * (1.0 / stiff - 1.0 / soft), side};
  }
}

void AnisotropicBend::begin_step(Rods& rods, const TimeStep& /*step*/) {
  values_.resize(rods.stiff_sides.size());
  for (std::uint32_t rod = 0; rod < rods.count() && !values_.empty(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      const StiffSide& side = rods.stiff_sides[i];
      const bool is_inner = i > rods.first(rod) && i + 1 < rods.end(rod);
      const double rest =
          is_inner && !rods.natural_curvature_vectors.empty()
              ? StiffBend::rest(side, rods.natural_curvature_vectors[i], rods.rest_length_at(i))
              : 0.0;
      values_[i] = {side.stiffness, side.side.x(), side.side.y(), rest};
    }
  }
}

void AnisotropicDamping::begin_step(Rods& rods, const TimeStep& step) {
  const double share = damping_->relaxation_time() / step.length;
  values_.assign(rods.stiff_sides.size(), {});
  for (std::uint32_t rod = 0; rod < rods.count() && !values_.empty(); ++rod) {
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      const StiffSide& side = rods.stiff_sides[i];
      double earlier = 0.0;
      if (side.stiffness > 0.0) {
        step.for_each_earlier(rods, [&](const RodState& state, double weight) {
          earlier += weight * StiffBend::strain(side, cross_section(rods, state, i - 1),
                                                cross_section(rods, state, i));
        });
      }
      values_[i] = {share * side.stiffness, side.side.x(), side.side.y(), earlier};
    }
  }
}

NodeData BendToSide::per_node_data() const {
  return {values_.empty() ? nullptr : values_.front().data(), values_.empty() ? 0U : 4U};
}

/// Such rods are rare, so that they are visited one after the other.
/// @param visit takes lane, node and bend
template <class Visit>
void BendToSide::for_each_bend(const RodPack& rods, const NodeValues& values,
                               const Visit& visit) const {
  for (std::size_t lane = 0; lane < rods.used && !values_.empty(); ++lane) {
    for (std::uint32_t node = 1; node + 1 < rods.node_count; ++node) {
      const SimdBatch* const of_node = values.data() + std::size_t{4} * node;
      const StiffSide side{of_node[0][lane], {of_node[1][lane], of_node[2][lane]}};
      if (side.stiffness > 0.0) {
        visit(lane, node, StiffBend::at_node(PackLane(rods, lane), node, side, of_node[3][lane]));
      }
    }
  }
}

void BendToSide::energy(const RodPack& rods, const NodeValues& values, SimdBatch& energy) const {
  energy = SimdBatch{};
  for_each_bend(rods, values, [&](std::size_t lane, std::uint32_t /*node*/, const StiffBend& bend) {
    energy[lane] += bend.energy();
  });
}

void BendToSide::add_derivatives(const RodPack& rods, const NodeValues& values,
                                 PackSystem& system) const {
  for_each_bend(rods, values, [&](std::size_t lane, std::uint32_t /*node*/, const StiffBend& bend) {
    RodSystem rod_system(system, lane);
    bend.add_derivatives(rod_system);
  });
}

void BendToSide::add_forces(const RodPack& rods, const NodeValues& values,
                            RodForces& forces) const {
  for_each_bend(rods, values, [&](std::size_t lane, std::uint32_t node, const StiffBend& bend) {
    forces.bending_moments[rods.first_nodes[lane] + node] += bend.moment();
  });
}

}  // namespace fiber
