#include "src/sim/scene/obstacles.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

#include "src/sim/overlaps.hpp"
#include "src/sim/scene/obstacle_motion.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/text/quote.hpp"

namespace fiber {

using Eigen::Isometry3d;

EnvironmentScene read_environment(const std::optional<YamlField>& field, const MeshSource& meshes,
                                  const LinkSource& links, SimDescription& scene) {
  const SimEffect* contact = scene.find_effect("environment_contact");
  if (!field && contact != nullptr) {
    throw std::invalid_argument(contact->place + ": the scene has no environment to touch");
  }
  const EnvironmentScene read =
      field ? read_moving_environment_scene(*field, meshes, links) : EnvironmentScene();
  std::vector<EnvironmentObject> objects;
  for (const SceneObstacle& obstacle : read.obstacles) {
    if (!obstacle.frame_id.empty() && obstacle.frame_id != scene.frame_id) {
      throw std::invalid_argument(field->place() + ": obstacle " + quote(obstacle.object.name) +
                                  " is in frame " + quote(obstacle.frame_id) +
                                  ", it must be in the scene's, " + quote(scene.frame_id));
    }
    if (obstacle.motion || obstacle.link) {
      scene.moving_obstacles.push_back(read_obstacle_motion(obstacle));
    } else {
      objects.push_back(obstacle.object);
    }
  }
  scene.environment = std::make_shared<const Environment>(std::move(objects));
  scene.moving_count = scene.moving_obstacles.size();
  return read;
}

std::shared_ptr<const Environment> environment_at_start(const SimDescription& scene) {
  if (scene.moving_obstacles.empty()) {
    return scene.environment;
  }
  std::vector<EnvironmentObject> objects = scene.environment->objects();
  for (const SimMovingObstacle& obstacle : scene.moving_obstacles) {
    if (!obstacle.frame) {
      objects.push_back(obstacle.object);
    }
  }
  return std::make_shared<const Environment>(std::move(objects));
}

std::vector<EnvironmentObject> SimScene::objects() const {
  std::vector<EnvironmentObject> all = environment->objects();
  if (const ObstacleMotions* const moving = motions()) {
    const std::vector<EnvironmentObject> placed = moving->placed();
    all.insert(all.end(), placed.begin(), placed.end());
  }
  return all;
}

const std::string& SimScene::object_name(std::uint32_t object) const {
  const std::size_t still = environment->objects().size();
  return object < still ? environment->objects()[object].name
                        : motions()->obstacles()[object - still].object.name;
}

void require_room(const SimDescription& description, const SimScene& scene,
                  const EnvironmentObject& object) {
  OverlapFinder::Options options;
  options.environment = std::make_shared<const Environment>(std::vector<EnvironmentObject>{object});
  options.allowed = description.allowed;
  const Rods& rods = scene.stepper->rods();
  constexpr std::uint32_t max_counted = 100;
  const std::vector<Overlap> overlaps =
      OverlapFinder(options).find(rods, touching_share, max_counted);
  if (overlaps.empty()) {
    return;
  }
  const Contact& contact = overlaps.front().contact;
  const double most = touching_share * radius_of(rods, contact.fiber_a, contact.segment_a);
  throw std::invalid_argument(format("segment ", contact.segment_a, " of fibre ",
                                     quote(scene.fiber_names[contact.fiber_a]), " is ",
                                     1e3 * overlaps.front().depth(), " mm deep inside of it, ",
                                     1e3 * most, " mm is the most"));
}

namespace {

std::uint32_t index_of(const SimScene& scene, const AddedObstacle& obstacle) {
  assert(&obstacle >= scene.added_obstacles.data());
  return static_cast<std::uint32_t>(scene.moving_count +
                                    (&obstacle - scene.added_obstacles.data()));
}

void add_on_path(SimScene& scene, const EnvironmentObject& object, const ObstaclePath& begin) {
  const auto path = std::make_shared<ObstaclePath>(begin);
  scene.stepper->add_obstacle({object, [path](double time) { return pose_at(*path, time); }});
  scene.added_obstacles.push_back({object.name, path});
}

}  // namespace

void add_obstacle(SimScene& scene, const EnvironmentObject& object) {
  add_on_path(scene, object, {{scene.stepper->time(), object.pose}});
}

const AddedObstacle* find_added(const SimScene& scene, const std::string& name) {
  const auto found = std::find_if(scene.added_obstacles.begin(), scene.added_obstacles.end(),
                                  [&name](const AddedObstacle& each) { return each.name == name; });
  return found == scene.added_obstacles.end() ? nullptr : &*found;
}

EnvironmentObject placed(const SimScene& scene, const AddedObstacle& obstacle) {
  const std::uint32_t index = index_of(scene, obstacle);
  EnvironmentObject object = scene.motions()->obstacles()[index].object;
  object.pose = scene.motions()->poses()[index];
  return object;
}

void move_obstacle(const SimScene& scene, const AddedObstacle& obstacle, const Isometry3d& pose,
                   double duration) {
  const double now = scene.stepper->time();
  *obstacle.path = {{now, scene.motions()->poses()[index_of(scene, obstacle)]},
                    {now + duration, pose}};
}

void remove_obstacle(SimScene& scene, const AddedObstacle& obstacle) {
  const std::uint32_t index = index_of(scene, obstacle);
  scene.stepper->remove_obstacle(index);
  scene.added_obstacles.erase(scene.added_obstacles.begin() +
                              static_cast<std::ptrdiff_t>(index - scene.moving_count));
}

void replace_shapes(SimScene& scene, const AddedObstacle& obstacle,
                    const std::vector<PlacedShape>& shapes) {
  EnvironmentObject object = placed(scene, obstacle);
  object.shapes = shapes;
  const ObstaclePath path = *obstacle.path;
  remove_obstacle(scene, obstacle);
  add_on_path(scene, object, path);
}

void copy_added_obstacles(const SimScene& scene, SimScene& copy) {
  for (const AddedObstacle& added : scene.added_obstacles) {
    add_on_path(copy, placed(scene, added), *added.path);
  }
}

}  // namespace fiber
