#pragma once

#include <numeric>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"

namespace fiber::test {

inline double sum(const std::vector<double>& energies) {
  return std::accumulate(energies.begin(), energies.end(), 0.0);
}

/// Finds contacts where rods are now. @returns their energy [J]
inline double measured_energy(Contacts& contacts, const Rods& rods) {
  std::vector<double> energies;
  contacts.measure(rods, energies);
  return sum(energies);
}

/// Of accepted contacts [J].
inline double accepted_energy(const Contacts& contacts, const Rods& rods) {
  std::vector<double> energies;
  contacts.energies(rods, energies);
  return sum(energies);
}

inline void find_and_accept(Contacts& contacts, const Rods& rods) {
  measured_energy(contacts, rods);
  contacts.accept(std::vector<bool>(rods.count(), true));
}

}  // namespace fiber::test
