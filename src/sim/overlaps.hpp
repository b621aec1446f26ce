#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// An edge of a rod whose surface is inside of another edge's, or of an object.
struct Overlap {
  /// Edges are counted from their rod's first one. With an object, fiber_b is its index and
  /// segment_b that of the shape.
  Contact contact;
  bool is_object = false;

  double depth() const { return -contact.distance; }
};

/// The radius of a segment, as contacts name them.
inline double radius_of(const Rods& rods, std::uint32_t rod, std::uint32_t segment) {
  return rods.edge_radius(rod, rods.first(rod) + segment);
}

inline double touching_distance(const Rods& rods, const Contact& contact) {
  return radius_of(rods, contact.fiber_a, contact.segment_a) +
         radius_of(rods, contact.fiber_b, contact.segment_b);
}

/// Finds overlaps, by the rule of FiberContact for edges of one rod.
class OverlapFinder {
 public:
  /// The pairs that must not overlap.
  struct Options {
    bool same_fiber = false;
    bool different_fibers = false;
    std::shared_ptr<const Environment> environment;  ///< null for none
    AllowedPairs allowed;                            ///< pairs of fibre and object that may overlap
  };

  explicit OverlapFinder(const Options& options);

  /// @param share depths up to this part of the radii's sum do not count
  /// @param max   how many to find between rods, and between rods and objects
  /// @returns the deepest ones, deepest first
  std::vector<Overlap> find(const Rods& rods, double share, std::uint32_t max);

 private:
  void find_between_rods(const Rods& rods, std::vector<Overlap>& found);

  Options options_;
  std::unique_ptr<ProximityEngine> engine_;
  FiberAssembly fibers_;
  QueryOptions query_;
  QueryResult result_;
};

/// Moves rods apart that are inside of each other or of objects, no further than it takes: where
/// two are, each moves by a half, and its neighbourhood along the rod with it, less and less. Axes
/// that meet or are the same part across both; if that leaves a choice, along z, y or x, whichever
/// is most across, the rod of the smaller index forwards.
/// @param is_held by node: these do not move
/// @returns overlaps of more than touching_share that are left after a bounded number of rounds
std::vector<Overlap> separate_overlaps(Rods& rods, OverlapFinder& finder,
                                       const std::vector<bool>& is_held);

/// Overlaps of at most this part of the sum of radii are ignored: polygons stand for curves, and
/// positions are written with few digits.
constexpr double touching_share = 0.01;

}  // namespace fiber
