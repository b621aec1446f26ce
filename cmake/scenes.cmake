# Fibres to measure with: scenes of the paper, of demos and of any size.

add_library(fiber_proximity_scenes SHARED
  src/scenes/cables.cpp
  src/scenes/cloth.cpp
  src/scenes/hair.cpp
  src/scenes/large_scene.cpp
  src/scenes/scalp.cpp
  src/scenes/scene.cpp
  src/scenes/soup.cpp
  src/scenes/tufts.cpp
)
target_link_libraries(fiber_proximity_scenes PUBLIC fiber_proximity PRIVATE fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_scenes ${core_headers})
fiber_proximity_component(scenes fiber_proximity_scenes)
