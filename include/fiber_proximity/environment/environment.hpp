#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// An object and a part of a fibre that may touch, such as a gripper and the end it holds: they are
/// no pair.
struct AllowedPair {
  static constexpr std::uint32_t every_fiber = std::numeric_limits<std::uint32_t>::max();

  std::string object;  ///< name; empty for every one
  std::uint32_t fiber = every_fiber;
  /// Segments of that part, both included; negative ones count from the end, -1 is the last.
  std::int64_t first_segment = 0;
  std::int64_t last_segment = -1;
};

using AllowedPairs = std::vector<AllowedPair>;

/// An AllowedPair whose fibre is named; neither object nor fibre need be there already.
struct NamedPair {
  std::string object;  ///< empty for every one
  std::string fiber;   ///< empty for every one

  /// First and last segment of a part of the fibre, as AllowedPair has them; empty for all of it.
  std::vector<std::int32_t> segments;

  bool operator<(const NamedPair& other) const {
    return std::tie(object, fiber, segments) < std::tie(other.object, other.fiber, other.segments);
  }
};

/// @throws std::invalid_argument naming object and fibre, for segments that are not the first and
///         the last of a part
void validate(const NamedPair& pair);

/// The pairs for these fibres; a name may be that of several.
AllowedPairs resolve(const std::vector<NamedPair>& pairs,
                     const std::vector<std::string>& fiber_names);

/// How an object moves from its pose: its origin linearly, while it turns about the origin at a
/// constant rate.
struct ObjectDisplacement {
  /// [rad] Objects that turn further in one motion are refused.
  static constexpr double max_rotation = 100.0;

  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m] of the origin, in the world
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< [rad] along its axis in the world
};

class ObjectPath;

/// The objects around the fibres at one moment; never changes once it is made, so that any number
/// of threads may ask at once while the next one is made.
///
/// A tree of boxes finds which shapes are near a run of segments; how far a segment is from a shape
/// is computed here, as FCL's answers cannot be relied on (docs/environment.md).
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
  /// do not apply. Many fibres are shared by all cores, or the threads of the arena this is called
  /// in; the answer is the same on any number.
  /// @param allowed pairs that are left out
  /// @throws std::invalid_argument for options that do not validate
  void query(const FiberAssembly& fibers, const QueryOptions& options, const AllowedPairs& allowed,
             QueryResult& result) const;

  /// A segment (a) and a shape of an object (b), however far apart: as query() has it, but for
  /// fiber_a and segment_a, which are 0.
  /// @throws std::out_of_range for an object or a shape that there is not
  Contact contact(const Capsule& segment, std::uint32_t object, std::uint32_t shape) const;

  /// Pairs of a segment (a) and a shape of an object (b), as query() has them, that come into
  /// contact while every point of the fibres moves linearly from where it is before to where it is
  /// after. Of each segment the larger radius counts. No contact is missed, however thin both are,
  /// and each time has proven bounds: see shape_contact_time.hpp. Pairs that query() reports before
  /// the motion are in `touching`, with the times 0. The pairing and the neighbour skips do not
  /// apply. Works on all cores; the answer is the same on any number.
  ///
  /// Objects move to where those of the same name are later: their positions move linearly, and
  /// they turn at a constant rate about one axis, the shorter way round, as tf interpolates.
  /// Objects that are not there later stand still; those that are only there later are not looked
  /// at.
  /// @param later this environment itself where all stand still
  /// @throws std::invalid_argument for options that do not validate, fibres that change their
  ///         topology, an object that has other shapes later, meshes and octrees not being the same
  ///         ones included, or for a tolerance of 0 where one turns
  void query_motion(const FiberAssembly& before, const FiberAssembly& after,
                    const Environment& later, const MotionOptions& options,
                    const AllowedPairs& allowed, MotionResult& result) const;

  /// The same where objects move by displacements: they may turn any way round, more than once.
  /// @param displacements by object
  /// @throws std::invalid_argument as above, for another number of displacements than there are
  ///         objects, for one that is not finite or larger than 1e150 m or max_rotation
  void query_motion(const FiberAssembly& before, const FiberAssembly& after,
                    const std::vector<ObjectDisplacement>& displacements,
                    const MotionOptions& options, const AllowedPairs& allowed,
                    MotionResult& result) const;

  /// A pair that query_motion() has found, as it is at time_of() it.
  Contact first_contact(const FiberMotion& motion, const Environment& later,
                        const MotionContact& contact) const;

 private:
  struct BroadPhase;

  void query_motion(const std::vector<ObjectPath>& paths, const FiberMotion& motion,
                    const MotionOptions& options, const AllowedPairs& allowed,
                    MotionResult& result) const;

  std::vector<EnvironmentObject> objects_;
  std::unique_ptr<const BroadPhase> broad_phase_;
};

}  // namespace fiber
