// What is there from the start, as YAML: the obstacles of the node's ~scene, from which the
// environment is made, and the contacts that are allowed.
#include "fiber_proximity/ros/allowed_contacts.hpp"
#include "fiber_proximity/ros/environment_scene.hpp"
#include "fiber_proximity/ros/load_yaml.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace fiber_proximity_ros;

void try_scene(const std::string& text) {
  const EnvironmentScene scene = read_scene(parse_yaml(text, "fuzz.yaml"), MeshLoader());
  fiber::World world;
  for (const FramedChange& obstacle : scene.obstacles) {
    world.apply({obstacle.change});
  }
  if (world.environment()->objects().size() != scene.obstacles.size()) {
    fiber::test::finding("obstacles that are not in the environment");
  }
  AllowedContacts allowed;
  fiber_proximity::AllowPairs::Request request;
  request.allow = scene.allowed;
  allowed.apply(request);
  allowed.resolve({"cable", "rope"});
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fiber::test::text_of(data, size);
  if (text.find("package://") != std::string::npos) {
    return 0;  // ROS would look for it in all packages there are
  }
  const fiber::test::Bounds bounds(fiber::test::times(2000, size));
  try {
    try_scene(text);
  } catch (const std::invalid_argument& error) {
    fiber::test::check_error(error);
  }
  return 0;
}
