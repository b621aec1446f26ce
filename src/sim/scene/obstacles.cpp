#include "src/sim/scene/obstacles.hpp"

#include <stdexcept>
#include <utility>

#include "src/sim/overlaps.hpp"
#include "src/sim/scene/obstacle_motion.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/text/quote.hpp"

namespace fiber {

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

}  // namespace fiber
