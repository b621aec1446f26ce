# The volumes, hierarchies and engines of the paper.

add_library(fiber_proximity_paper SHARED
  src/paper/bounds/direction_set.cpp
  src/paper/bounds/kdop.cpp
  src/paper/bounds/obb.cpp
  src/paper/bounds/sphere.cpp
  src/paper/engines/kdop_engines.cpp
  src/paper/engines/paper_engines.cpp
  src/paper/hierarchy/cascaded_hierarchy.cpp
)
target_link_libraries(fiber_proximity_paper PUBLIC fiber_proximity PRIVATE fiber_proximity_options)
# Once registered, its engines are in the factory of the core, which may outlive a plugin that loaded this library.
target_link_options(fiber_proximity_paper PRIVATE LINKER:-z,nodelete)
# Takes a minute: alone, beside the others.
set_source_files_properties(src/paper/engines/kdop_engines.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
fiber_proximity_parse_once(fiber_proximity_paper ${core_headers})
fiber_proximity_component(paper fiber_proximity_paper)
