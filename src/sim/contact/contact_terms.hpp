#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "src/sim/contact/surface_lever.hpp"

namespace fiber {

/// A term of the contacts' gradient and Hessian, by the difference of two points.
struct ContactTerm {
  ContactPoints points;
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;
  double turning;  ///< times g gᵀ, part of the Hessian by the difference of a's ends [1/(N m)]
  const SurfaceLevers* levers;  ///< from the axes to the points; null where they are on the axes
};

/// A part g gᵀ of the contacts' Hessian: of contacts whose energy depends on several distances
/// together.
struct ContactCoupling {
  ContactPoints points;                 ///< that of the first distance
  std::array<Eigen::Vector3d, 2> of_a;  ///< g by the ends of a's edge
  std::array<Eigen::Vector3d, 2> of_b;  ///< and by those of b's, zero for an obstacle
};

struct ContactDerivatives {
  std::vector<ContactTerm> terms;
  std::vector<ContactCoupling> couplings;

  void clear() {
    terms.clear();
    couplings.clear();
  }
};

/// Derivatives by chunk of contacts. Threads share the chunks.
using ContactTerms = std::vector<ContactDerivatives>;

/// Adds the gradient to some rods, and the blocks of the Hessian between nodes of one edge.
/// @param systems  by rod
/// @param packs    by rod
/// @param which    pack the rods are of
void add_derivatives(const ContactTerms& terms, const Rods& rods,
                     const std::vector<RodSystem*>& systems,
                     const std::vector<std::uint32_t>& packs, std::uint32_t which);

/// Whether the Hessian has other blocks: those between two rods' edges.
bool has_coupling(const ContactTerms& terms);

/// Adds the product of these other blocks with displacements.
/// @param places        of each node's x in these arrays; y and z are lane_count further each
/// @param displacements of all unknowns
void add_coupling(const ContactTerms& terms, const std::vector<std::size_t>& places,
                  const SimdBatch* displacements, SimdBatch* product);

}  // namespace fiber
