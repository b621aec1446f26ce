#pragma once

#include <Eigen/Dense>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "src/sim/contact/contact_set.hpp"
#include "src/sim/solver/step_bound.hpp"

namespace fiber::test {

/// The contacts of rods from where they are, if none goes further than some bound [m].
inline ContactSet contacts_of(Contacts& contacts, const Rods& rods, double room = 0.0) {
  TravelBound around;
  around.start = rods.positions;
  around.expected.assign(rods.positions.size(), Eigen::Vector3d::Zero());
  around.by_rod.assign(rods.count(), room);
  ContactSet found;
  for (const std::unique_ptr<ContactSource>& source : contacts.sources()) {
    source->find(rods, around, found);
  }
  return found;
}

/// Energy of contacts, and of friction if they have begun with it [J].
inline double energy_in(ContactSet& contacts, const Rods& rods) {
  std::vector<EnergySum> energies(1);
  contacts.update_distances(rods);
  contacts.evaluate_energies(rods);
  contacts.add_energies(std::vector<std::uint32_t>(rods.count(), 0), energies);
  return energies[0].energy;
}

/// The contacts' part of the equations of all rods, as full vectors and matrices: x, y, z and with
/// twist the angle, node by node.
struct FullSystem {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

inline FullSystem full_system(ContactSet& contacts, const Rods& rods) {
  const std::size_t unknowns = rods.angles.empty() ? 3 : 4;
  const auto size = static_cast<Eigen::Index>(unknowns * rods.positions.size());
  std::vector<PackSystem> packs(rods.count());
  std::vector<RodSystem> systems;
  systems.reserve(rods.count());
  std::vector<RodSystem*> pointers;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    packs[rod].resize(rods.node_count(rod), unknowns);
    packs[rod].set_zero();
    systems.emplace_back(packs[rod], rod % lane_count);
    pointers.push_back(&systems.back());
  }
  contacts.update_distances(rods);
  contacts.find_derivatives(rods);
  add_derivatives(contacts.terms(), rods, pointers, std::vector<std::uint32_t>(rods.count(), 0), 0);
  FullSystem full{Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const std::size_t first = unknowns * rods.first(rod);
    const std::size_t count = packs[rod].size();
    for (std::size_t c = 0; c < count; ++c) {
      const auto column = static_cast<Eigen::Index>(first + c);
      full.gradient[column] = systems[rod].gradient(c);
      for (std::size_t r = c; r < std::min(count, c + half_bandwidth(unknowns) + 1); ++r) {
        const auto row = static_cast<Eigen::Index>(first + r);
        full.hessian(row, column) = full.hessian(column, row) = systems[rod].hessian(r, c);
      }
    }
  }
  // Unknowns in lanes of their own, node by node.
  std::vector<std::size_t> places;
  for (std::size_t node = 0; node < rods.positions.size(); ++node) {
    places.push_back(unknowns * node * lane_count);
  }
  using Spread = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<lane_count>>;
  for (Eigen::Index c = 0; c < size; ++c) {
    NodeValues unit(rods.positions.size() * unknowns);
    NodeValues column(unit.size());
    unit[static_cast<std::size_t>(c)][0] = 1.0;
    add_coupling(contacts.terms(), places, unit.data(), column.data());
    full.hessian.col(c) += Spread(column.data()->lanes.data(), size);
  }
  return full;
}

/// The derivatives of a number or a vector by the unknowns of rods, by central differences [m or
/// rad]: one column each.
template <class Function>
Eigen::MatrixXd derivatives_by_differences(Rods rods, const Function& function, double difference) {
  const std::size_t unknowns = rods.angles.empty() ? 3 : 4;
  Eigen::MatrixXd derivatives;
  for (std::size_t i = 0; i < unknowns * rods.positions.size(); ++i) {
    const std::size_t node = i / unknowns;
    const std::size_t part = i % unknowns;
    double& x =
        part == 3 ? rods.angles[node] : rods.positions[node][static_cast<Eigen::Index>(part)];
    const double middle = x;
    x = middle + difference;
    const Eigen::VectorXd after = function(rods);
    x = middle - difference;
    const Eigen::VectorXd before = function(rods);
    x = middle;
    derivatives.conservativeResize(after.size(), static_cast<Eigen::Index>(i + 1));
    derivatives.rightCols(1) = (after - before) / (2.0 * difference);
  }
  return derivatives;
}

/// The gradient of an energy by the unknowns of rods, by central differences [m or rad].
template <class Energy>
Eigen::VectorXd gradient_by_differences(const Rods& rods, const Energy& energy, double difference) {
  const auto as_vector = [&energy](const Rods& r) {
    return Eigen::VectorXd::Constant(1, energy(r));
  };
  return derivatives_by_differences(rods, as_vector, difference).transpose();
}

}  // namespace fiber::test
