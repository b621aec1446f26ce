#include "src/sim/overlaps.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "src/sim/contact/contact_neighbours.hpp"
#include "src/sim/edges.hpp"
#include "src/sim/joint/unite_joints.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The least length that the rod between two edges of one rod that may touch has now [m].
double min_length_now(const Rods& rods) {
  double min_length = std::numeric_limits<double>::infinity();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double ratio = 1.0 - 1e-12;  // for rounding
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const double now = (rods.positions[i + 1] - rods.positions[i]).norm();
      ratio = std::min(ratio, now / rods.rest_lengths[i]);
    }
    const double thinnest = rods.edge_radii.empty()
                                ? rods.radii[rod]
                                : *std::min_element(rods.edge_radii.begin() + rods.first(rod),
                                                    rods.edge_radii.begin() + rods.end(rod) - 1);
    min_length = std::min(min_length, ratio * 4.0 * thinnest);
  }
  return min_length;
}

}  // namespace

OverlapFinder::OverlapFinder(const Options& options)
    : options_(options), engine_(make_engine("run_tree")) {
  query_.type = QueryType::LIMITED;
  query_.pairing = options.same_fiber && options.different_fibers ? Pairing::ALL
                   : options.same_fiber                           ? Pairing::SAME_FIBER
                                                                  : Pairing::DIFFERENT_FIBERS;
}

std::vector<Overlap> OverlapFinder::find(const Rods& rods, double share, std::uint32_t max) {
  query_.max_contacts = max;
  fibers_ = FiberAssembly(rods.positions, rods.offsets, rods.assembly_radii());
  // Some of these segments may be thicker than the edges.
  const auto excess = [&](std::uint32_t rod, std::uint32_t segment) {
    return fibers_.segment_radius(rods.first(rod) + segment) - radius_of(rods, rod, segment);
  };
  std::vector<Overlap> found;
  if (options_.same_fiber || options_.different_fibers) {
    find_between_rods(rods, found);
    found.erase(
        std::remove_if(found.begin(), found.end(),
                       [&](Overlap& overlap) {
                         Contact& contact = overlap.contact;
                         contact.distance += excess(contact.fiber_a, contact.segment_a) +
                                             excess(contact.fiber_b, contact.segment_b);
                         return !(-contact.distance > share * touching_distance(rods, contact));
                       }),
        found.end());
  }
  if (options_.environment != nullptr) {
    options_.environment->query(fibers_, query_, options_.allowed, result_);
    for (Contact contact : result_.contacts) {
      contact.distance += excess(contact.fiber_a, contact.segment_a);
      if (-contact.distance > share * radius_of(rods, contact.fiber_a, contact.segment_a)) {
        found.push_back({contact, true});
      }
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Overlap& a, const Overlap& b) {
    return a.contact.distance < b.contact.distance;
  });
  return found;
}

void OverlapFinder::find_between_rods(const Rods& rods, std::vector<Overlap>& found) {
  query_.neighbour_skip = contact_neighbour_skip;
  // Neighbours that are dropped below should not use up the limit.
  query_.neighbour_skip_length = min_length_now(rods);
  engine_->update(fibers_);
  engine_->query(query_, result_);
  const ContactNeighbours neighbours(rods);
  for (const Contact& contact : result_.contacts) {
    const bool are_neighbours =
        neighbours.contain(rods, contact.fiber_a, rods.first(contact.fiber_a) + contact.segment_a,
                           contact.fiber_b, rods.first(contact.fiber_b) + contact.segment_b);
    if (!are_neighbours) {
      found.push_back({contact, false});
    }
  }
}

}  // namespace fiber
