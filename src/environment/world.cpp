#include "fiber_proximity/environment/world.hpp"

#include <stdexcept>
#include <string_view>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Operation = ObjectChange::Operation;

[[noreturn]] void refuse(const EnvironmentObject& object, const std::string& why) {
  throw std::invalid_argument("object " + quote(object.name) + ": " + why);
}

bool adds(const ObjectChange& change) {
  return change.operation == Operation::ADD || change.operation == Operation::APPEND;
}

}  // namespace

void validate(const ObjectChange& change) {
  const EnvironmentObject& object = change.object;
  validate(object);
  if (adds(change) && object.shapes.empty()) {
    refuse(object, "an object to add or to append to needs at least 1 shape, it has none");
  }
  if (change.operation == Operation::MOVE && !object.shapes.empty()) {
    refuse(object, "it is to be moved, but comes with shapes; to replace these, add it");
  }
}

void World::apply(const std::vector<ObjectChange>& changes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  check(changes, objects_);
  for (const ObjectChange& change : changes) {
    apply(change, objects_);
  }
  if (!changes.empty()) {
    environment_.reset();
  }
}

/// Refuses changes of which one cannot be made, after those before it.
void World::check(const std::vector<ObjectChange>& changes, const Objects& objects) {
  std::map<std::string_view, bool> is_there;  // of objects that the changes add or remove
  for (const ObjectChange& change : changes) {
    const EnvironmentObject& object = change.object;
    validate(change);
    if (!adds(change)) {
      const auto changed = is_there.find(object.name);
      if (changed != is_there.end() ? !changed->second : objects.count(object.name) == 0) {
        refuse(object, "there is no object of this name to move or to remove");
      }
    }
    if (change.operation != Operation::MOVE) {
      is_there[object.name] = adds(change);
    }
  }
}

/// Makes a change that has been checked.
void World::apply(const ObjectChange& change, Objects& objects) {
  const EnvironmentObject& object = change.object;
  const auto place = objects.find(object.name);
  const bool exists = place != objects.end();
  switch (change.operation) {
    case Operation::ADD:
      objects[object.name] = object;
      break;
    case Operation::REMOVE:
      objects.erase(place);
      break;
    case Operation::APPEND:
      if (exists) {
        auto& shapes = place->second.shapes;
        shapes.insert(shapes.end(), object.shapes.begin(), object.shapes.end());
      } else {
        objects[object.name] = object;
      }
      break;
    case Operation::MOVE:
      place->second.pose = object.pose;
      break;
  }
}

bool World::has(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return objects_.count(name) > 0;
}

std::size_t World::object_count() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return objects_.size();
}

std::shared_ptr<const Environment> World::environment() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (environment_ == nullptr) {
    std::vector<EnvironmentObject> objects;
    objects.reserve(objects_.size());
    for (const auto& [name, object] : objects_) {
      objects.push_back(object);
    }
    environment_ = std::make_shared<const Environment>(std::move(objects));
  }
  return environment_;
}

}  // namespace fiber
