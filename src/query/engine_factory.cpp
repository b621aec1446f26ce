#include <charconv>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/query/engine.hpp"
#include "src/bounds/direction_set.hpp"
#include "src/bounds/obb.hpp"
#include "src/bounds/sphere.hpp"
#include "src/hierarchy/cascaded_hierarchy.hpp"
#include "src/hierarchy/spatial_hierarchy.hpp"
#include "src/hierarchy/wrapped_hierarchy.hpp"
#include "src/query/brute_force.hpp"
#include "src/query/hierarchy_engine.hpp"
#include "src/query/kdop_engines.hpp"
#include "src/query/run_tree_engine.hpp"
#include "src/query/threads.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using EnginePointer = std::unique_ptr<ProximityEngine>;

template <class Kind>
EnginePointer make(const EngineOptions& /*options*/) {
  return std::make_unique<HierarchyEngine<Kind>>(Kind());
}

EnginePointer make_threaded(const EngineOptions& /*options*/) {
  using Kind = LayeredHierarchy<Aabb>;
  return std::make_unique<HierarchyEngine<Kind>>(Kind({}, threading_order));
}

EnginePointer make_run_tree(const EngineOptions& options) {
  return std::make_unique<RunTreeEngine>(options);
}

EnginePointer make_brute_force(const EngineOptions& /*options*/) {
  return std::make_unique<BruteForceEngine>();
}

/// The paper's best k for hair (Sect. 5).
template <EnginePointer (*MakeKdop)(const std::vector<Eigen::Vector3d>&)>
EnginePointer make_kdop_20(const EngineOptions& /*options*/) {
  return MakeKdop(grassmannian_directions(20));
}

using Maker = EnginePointer (*)(const EngineOptions& threads);

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> all{
      {"run_tree", make_run_tree},
      {"AL", make<LayeredHierarchy<Aabb>>},
      {"AL-threaded", make_threaded},
      {"AS", make<SpatialHierarchy<Aabb>>},
      {"DL-20", make_kdop_20<make_layered_kdop_engine>},
      {"DS-20", make_kdop_20<make_spatial_kdop_engine>},
      {"SL", make<LayeredHierarchy<Sphere>>},
      {"SW", make<CascadedHierarchy>},
      {"SS", make<SpatialHierarchy<Sphere>>},
      {"OL", make<LayeredHierarchy<Obb>>},
      {"OW", make<WrappedHierarchy<Obb>>},
      {"OS", make<SpatialHierarchy<Obb>>},
      {"brute_force", make_brute_force},
  };
  return all;
}

/// The engine of a name DL-k, DS-k, DL-k-classic or DS-k-classic; null for any other name.
/// @throws std::invalid_argument for a k that cannot be had
EnginePointer make_kdop_engine(const std::string& name) {
  const std::string kind = name.substr(0, 3);
  if (kind != "DL-" && kind != "DS-") {
    return nullptr;
  }
  int k = 0;
  const char* const end = name.data() + name.size();
  const std::from_chars_result number = std::from_chars(name.data() + kind.size(), end, k);
  const std::string suffix(number.ptr, end);
  if (number.ec != std::errc() || (!suffix.empty() && suffix != "-classic")) {
    return nullptr;
  }
  const std::vector<Eigen::Vector3d>& directions =
      suffix.empty() ? grassmannian_directions(k) : classic_directions(k);
  return kind == "DL-" ? make_layered_kdop_engine(directions)
                       : make_spatial_kdop_engine(directions);
}

}  // namespace

EnginePointer make_engine(const std::string& name, const EngineOptions& options) {
  validate_threads(options.threads);  // also where the engine has one thread
  std::string known;
  for (const auto& [engine_name, maker] : makers()) {
    if (name == engine_name) {
      return maker(options);
    }
    known += (known.empty() ? "" : ", ") + engine_name;
  }
  std::string reason;
  try {
    if (EnginePointer kdop = make_kdop_engine(name)) {
      return kdop;
    }
  } catch (const std::invalid_argument& error) {
    reason = std::string(" (") + error.what() + ")";
  }
  throw std::invalid_argument("unknown engine " + quote(name) + reason + ", known are: " + known +
                              "; DL-k and DS-k for even k from 6 to 200; DL-k-classic and "
                              "DS-k-classic for k of 6, 14, 18, 26");
}

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const auto& entry : makers()) {
    names.push_back(entry.first);
  }
  return names;
}

}  // namespace fiber
