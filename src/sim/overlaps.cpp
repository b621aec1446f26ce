#include "fiber_proximity/sim/overlaps.hpp"

#include <algorithm>
#include <limits>

#include "src/sim/contact/neighbours.hpp"

namespace fiber {
namespace {

/// [m] What lies between two edges of a rod that may touch is now at least this.
double least_length_now(const Rods& rods) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double ratio = 1.0 - 1e-12;  // for rounding
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const double now = (rods.positions[i + 1] - rods.positions[i]).norm();
      ratio = std::min(ratio, now / rods.rest_lengths[i]);
    }
    least = std::min(least, ratio * contact_neighbour_length(rods, rod));
  }
  return least;
}

}  // namespace

OverlapFinder::OverlapFinder(const Options& options)
    : options_(options), engine_(make_engine("run_tree")) {
  query_.type = QueryType::LIMITED;
  query_.pairing = options.same_fiber && options.different_fibers ? Pairing::ALL
                   : options.same_fiber                           ? Pairing::SAME_FIBER
                                                                  : Pairing::DIFFERENT_FIBERS;
}

std::vector<Overlap> OverlapFinder::find(const Rods& rods, double share, std::uint32_t most) {
  query_.max_contacts = most;
  fibers_ = FiberAssembly(rods.positions, rods.offsets, rods.radii);
  std::vector<Overlap> found;
  if (options_.same_fiber || options_.different_fibers) {
    find_between_rods(rods, share, found);
  }
  if (options_.environment != nullptr) {
    find_in_objects(rods, share, found);
  }
  std::stable_sort(found.begin(), found.end(), [](const Overlap& a, const Overlap& b) {
    return a.contact.distance < b.contact.distance;
  });
  return found;
}

void OverlapFinder::find_between_rods(const Rods& rods, double share, std::vector<Overlap>& found) {
  query_.neighbour_skip = contact_neighbour_skip;
  // Not all that the rule of lengths leaves out is to use up the most.
  query_.neighbour_skip_length = least_length_now(rods);
  engine_->update(fibers_);
  engine_->query(query_, result_);
  const std::vector<double> arcs = contact_arcs(rods);
  for (const Contact& contact : result_.contacts) {
    const double touching = rods.radii[contact.fiber_a] + rods.radii[contact.fiber_b];
    const bool are_neighbours =
        contact.fiber_a == contact.fiber_b &&
        are_contact_neighbours(rods, arcs, contact.fiber_a,
                               rods.first(contact.fiber_a) + contact.segment_a,
                               rods.first(contact.fiber_b) + contact.segment_b);
    if (-contact.distance > share * touching && !are_neighbours) {
      found.push_back({contact, false});
    }
  }
}

void OverlapFinder::find_in_objects(const Rods& rods, double share, std::vector<Overlap>& found) {
  options_.environment->query(fibers_, query_, options_.allowed, result_);
  for (const Contact& contact : result_.contacts) {
    if (-contact.distance > share * rods.radii[contact.fiber_a]) {
      found.push_back({contact, true});
    }
  }
}

}  // namespace fiber
