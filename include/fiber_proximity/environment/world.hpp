#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"

namespace fiber {

/// A change to the world, as moveit_msgs/CollisionObject has them.
struct ObjectChange {
  enum class Operation {
    ADD,     ///< the object, in place of one of the same name
    REMOVE,  ///< the object of this name
    APPEND,  ///< the shapes to the object of this name, which may be new; its pose stays
    MOVE     ///< the object of this name to this pose; without shapes
  };
  Operation operation = Operation::ADD;
  EnvironmentObject object;
};

/// Looks at a change without the world that it is for.
/// @throws std::invalid_argument naming the object: as validate(EnvironmentObject), for no shapes
///         to ADD or APPEND, and shapes with a MOVE
void validate(const ObjectChange& change);

/// Objects by name, and how they change. All functions may be called from any thread at any time:
/// queries go to the environment of a moment, which does not change any more.
class World {
 public:
  /// Applies all changes, one after the other, or none.
  /// @throws std::invalid_argument naming the object: as validate(ObjectChange), and for a REMOVE
  ///         or MOVE of an object that is not there
  void apply(const std::vector<ObjectChange>& changes);

  bool has(const std::string& name) const;
  std::size_t object_count() const;

  /// The objects there are now, by name. Made when it is first asked for after a change.
  std::shared_ptr<const Environment> environment() const;

 private:
  using Objects = std::map<std::string, EnvironmentObject>;

  static void check(const std::vector<ObjectChange>& changes, const Objects& objects);
  static void apply(const ObjectChange& change, Objects& objects);

  mutable std::mutex mutex_;
  Objects objects_;
  mutable std::shared_ptr<const Environment> environment_;  // null after a change
};

}  // namespace fiber
