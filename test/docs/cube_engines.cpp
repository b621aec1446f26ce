#include "fiber_proximity/query/engine.hpp"
#include "src/paper/engines/hierarchy_engine.hpp"
#include "src/paper/hierarchy/hierarchy.hpp"
#include "test/docs/cube.hpp"

namespace fiber {
namespace {

std::unique_ptr<ProximityEngine> make_cube_engine(const std::string& name, const EngineOptions&) {
  if (name == "CL") {
    return std::make_unique<HierarchyEngine<LayeredHierarchy<Cube>>>(LayeredHierarchy<Cube>());
  }
  if (name == "CS") {
    return std::make_unique<HierarchyEngine<SpatialHierarchy<Cube>>>(SpatialHierarchy<Cube>());
  }
  return nullptr;
}

[[maybe_unused]] const bool is_registered = register_engines({{"CL", "CS"}, make_cube_engine, ""});

}  // namespace
}  // namespace fiber
