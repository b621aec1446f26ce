#include "fiber_proximity/paper/paper_engines.hpp"

#include <charconv>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/query/engine.hpp"
#include "src/paper/bounds/direction_set.hpp"
#include "src/paper/bounds/obb.hpp"
#include "src/paper/bounds/sphere.hpp"
#include "src/paper/engines/hierarchy_engine.hpp"
#include "src/paper/hierarchy/hierarchy.hpp"

namespace fiber {
namespace {

using EnginePointer = std::unique_ptr<ProximityEngine>;
using Maker = EnginePointer (*)();

template <class Kind>
EnginePointer make() {
  return std::make_unique<HierarchyEngine<Kind>>(Kind());
}

EnginePointer make_threaded() {
  using Kind = LayeredHierarchy<Aabb>;
  return std::make_unique<HierarchyEngine<Kind>>(Kind({}, threading_order));
}

/// The paper's best k for hair (Sect. 5).
template <EnginePointer (*MakeKdop)(const std::vector<Eigen::Vector3d>&)>
EnginePointer make_kdop_20() {
  return MakeKdop(grassmannian_directions(20));
}

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> all{
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

EnginePointer make_paper_engine(const std::string& name, const EngineOptions& /*options*/) {
  for (const auto& [engine_name, maker] : makers()) {
    if (name == engine_name) {
      return maker();
    }
  }
  return make_kdop_engine(name);
}

EngineFamily paper_family() {
  EngineFamily family;
  for (const auto& entry : makers()) {
    family.names.push_back(entry.first);
  }
  family.make = make_paper_engine;
  family.other_names =
      "DL-k and DS-k for even k from 6 to 200; DL-k-classic and DS-k-classic for k of 6, 14, 18, "
      "26";
  return family;
}

}  // namespace

void register_paper_engines() {
  // Once in a process, whoever calls and on however many threads.
  [[maybe_unused]] static const bool is_registered = register_engines(paper_family());
}

}  // namespace fiber
