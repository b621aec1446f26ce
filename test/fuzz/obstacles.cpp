// What is there from the start, as YAML: the obstacles of the node's ~scene, from which the
// environment is made, and the contacts that are allowed.
#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/environment/allowed_contacts.hpp"
#include "test/fuzz/fuzz_target.hpp"
#include "test/fuzz/no_mesh.hpp"

namespace {

using namespace fiber;

void try_scene(const std::string& text) {
  const EnvironmentScene scene =
      read_environment_scene(parse_yaml(text, "fuzz.yaml"), test::no_mesh);
  std::vector<EnvironmentObject> objects;
  for (const SceneObstacle& obstacle : scene.obstacles) {
    objects.push_back(obstacle.object);
  }
  if (Environment(objects).objects().size() != scene.obstacles.size()) {
    test::finding("obstacles that are not in the environment");
  }
  AllowedContacts allowed;
  allowed.apply(false, {}, scene.allowed);
  resolve(allowed.pairs(), {"cable", "rope"});
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fiber::test::text_of(data, size);
  const fiber::test::Bounds bounds(fiber::test::times(2000, size));
  try {
    try_scene(text);
  } catch (const std::invalid_argument& error) {
    fiber::test::check_error(error);
  }
  return 0;
}
