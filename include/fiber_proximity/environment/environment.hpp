#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/environment/allowed_pairs.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// The objects around the fibres at one moment; never changes once it is made, so that any number
/// of threads may ask at once while the next one is made.
///
/// FCL's dynamic AABB tree finds which shapes are near a run of segments; how far a segment is from
/// a shape is computed here, as FCL's answers cannot be relied on (docs/environment.md).
class Environment {
 public:
  /// @throws std::invalid_argument as validate(EnvironmentObject), or for two objects of one name
  explicit Environment(std::vector<EnvironmentObject> objects);
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

  const std::vector<EnvironmentObject>& objects() const { return objects_; }

  /// Pairs of a segment of the fibres (a) and a shape of an object: fiber_b is the index of the
  /// object, segment_b that of the shape in it, t is 0. FIBER_PAIRS asks for the closest pair of
  /// each fibre and each object. The distance is that of the capsule's axis from the shape, less
  /// the radius; of axes inside of a solid that of the deepest point. Kernel and neighbour skips
  /// do not apply.
  /// @param allowed pairs that are left out
  /// @throws std::invalid_argument for options that do not validate
  void query(const FiberAssembly& fibers, const QueryOptions& options, const AllowedPairs& allowed,
             QueryResult& result) const;

 private:
  class BroadPhase;

  std::vector<EnvironmentObject> objects_;
  std::unique_ptr<const BroadPhase> broad_phase_;
};

}  // namespace fiber
