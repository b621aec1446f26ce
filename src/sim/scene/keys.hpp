// Which keys a scene may have: the readers take their limits from here, and docs/scene_keys.md its
// tables.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fiber {

constexpr std::int64_t max_segments = 1000000;  ///< of all fibres of a scene together, too
constexpr std::int64_t max_repeats = 100000;
constexpr std::uint32_t max_substeps = 1000;
constexpr std::int64_t max_step_iterations = 1000;
constexpr double max_initial_speed = 1000.0;  ///< of a fibre's points [m/s]

/// The range in which a number must be. All numbers must be finite.
struct KeyLimits {
  double min = 0.0;
  double max = std::numeric_limits<double>::infinity();
  bool excludes_min = false;
  bool excludes_max = false;

  bool contain(double value) const;
  std::string text() const;  ///< "above 0 and at most 10"
};

/// A key of a map in a scene.
struct SceneKey {
  std::string name;     ///< that of an option in a map of options begins with the map's: wind.mean
  std::string allowed;  ///< what its value must be
  std::string by_default;  ///< as the reference shows it; "required", or empty if it may be absent
  std::string unit;
  std::string text;
  std::vector<double> numbers;      ///< of an effect's numeric option: the default
  std::optional<KeyLimits> limits;  ///< of each number
};

/// A map in a scene: the scene itself, a fibre, a shape, an effect, and so on.
struct SceneMap {
  std::string name;   ///< of an effect, its own; of a shape, its own with "shape " before it
  std::string about;  ///< sentences
  bool is_effect = false;
  std::vector<SceneKey> keys;
};

/// All maps, in the order in which the reference tells of them.
const std::vector<SceneMap>& scene_maps();

/// The keys of a map. Its name must be one of scene_maps().
const std::vector<SceneKey>& keys_of_scene_map(const std::string& name);

/// The names of the keys of a map.
std::vector<std::string> key_names(const std::string& map);

/// The limits of a number. The key must have some.
const KeyLimits& key_limits(const std::string& map, const std::string& key);

}  // namespace fiber
