// Scenes of the simulation, as YAML: from the document to the rods, effects and contacts that are
// ready to move.
#include <yaml-cpp/yaml.h>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "test/fuzz/fuzz_target.hpp"
#include "test/fuzz/no_mesh.hpp"

namespace {

using namespace fiber;

/// A scene may have a million segments, which is no longer to write than one. Those of the fuzzer
/// have few, so that what they cost is what there is of them to read.
constexpr std::int64_t most_segments = 40;

std::int64_t number_of(const YAML::Node& map, const char* key) {
  std::int64_t number = 1;
  if (map.IsMap() && map[key].IsDefined() && map[key].IsScalar()) {
    YAML::convert<std::int64_t>::decode(map[key], number);
  }
  return number;
}

bool writes_few_segments(const YAML::Node& fibers) {
  std::int64_t segments = 0;
  if (fibers.IsSequence()) {
    for (const YAML::Node& fiber : fibers) {
      const std::int64_t of_one = number_of(fiber, "segments");
      const std::int64_t count =
          fiber.IsMap() && fiber["repeat"].IsDefined() ? number_of(fiber["repeat"], "count") : 1;
      if (of_one > most_segments || count > most_segments) {
        return false;
      }
      segments += of_one * count;
    }
  }
  return segments <= most_segments;
}

/// The times of frames are made up: 1 us for each node and step.
SimDescription read(const YamlField& document) {
  return read_sim_scene(document, test::no_mesh, [](const SimDescription& scene, double) {
    return std::vector<double>{1e-6 *
                               static_cast<double>(scene.rods.positions.size() * scene.substeps)};
  });
}

/// Few segments of those that the scene's accuracy takes, too.
bool has_few_segments(const std::string& text, const YamlField& document) {
  const YAML::Node node = YAML::Load(text);
  if (!node.IsMap() || !node["fibers"].IsDefined()) {
    return true;
  }
  if (!writes_few_segments(node["fibers"])) {
    return false;
  }
  if (!node["accuracy"].IsDefined() && !node["real_time"].IsDefined()) {
    return true;
  }
  return read(document).rods.positions.size() <= std::size_t{2} * most_segments;
}

void try_scene(const std::string& text, double seconds = 1.0) {
  const YamlField document = parse_yaml(text, "fuzz.yaml");
  if (!has_few_segments(text, document)) {
    return;
  }
  const test::Bounds bounds(test::times(2000, text.size()), seconds);
  const SimDescription description = read(document);
  const SimScene scene = make_sim_scene(description, 1);
  if (scene.stepper->rods().count() != scene.fiber_names.size()) {
    test::finding("rods that are not the scene's fibres");
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  // The first knot is made for all, which takes a second with sanitizers.
  try_scene(
      "{fibers: [{name: a, shape: {trefoil: {center: [0, 0, 0], size: 1}}, segments: 20, radius: "
      "0.001, material: hair}], effects: [stretch]}",
      60.0);
  return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fiber::test::text_of(data, size);
  try {
    try_scene(text);
  } catch (const std::invalid_argument& error) {
    fiber::test::check_error(error);
  }
  return 0;
}
