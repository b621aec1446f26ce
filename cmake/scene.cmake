# Scenes from YAML files: what is around the fibres, and what the simulation moves; no ROS.

find_package(yaml-cpp REQUIRED)
# Its CMake package differs from version to version.
find_path(ASSIMP_INCLUDE_FOLDER assimp/scene.h)
find_library(ASSIMP_LIBRARY assimp)
if(NOT ASSIMP_INCLUDE_FOLDER OR NOT ASSIMP_LIBRARY)
  message(FATAL_ERROR "assimp is not installed (libassimp-dev): it reads meshes")
endif()
set(yaml_headers ${core_headers} <yaml-cpp/yaml.h>)

add_library(fiber_proximity_environment_scene SHARED
  src/environment/scene/environment_scene.cpp
  src/environment/scene/mesh_files.cpp
  src/environment/scene/parse_mesh.cpp
  src/yaml/load_yaml.cpp
  src/yaml/yaml_field.cpp
)
target_include_directories(fiber_proximity_environment_scene SYSTEM PRIVATE ${ASSIMP_INCLUDE_FOLDER})
target_link_libraries(fiber_proximity_environment_scene
  PUBLIC fiber_proximity_environment yaml-cpp PRIVATE ${ASSIMP_LIBRARY} fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_environment_scene ${yaml_headers})

add_library(fiber_proximity_sim_scene SHARED
  src/sim/scene/description.cpp
  src/sim/scene/effects.cpp
  src/sim/scene/fibers.cpp
  src/sim/scene/force_file.cpp
  src/sim/scene/holds.cpp
  src/sim/scene/lead.cpp
  src/sim/scene/natural_curvature.cpp
  src/sim/scene/overlap.cpp
  src/sim/scene/parameters.cpp
  src/sim/scene/report.cpp
  src/sim/scene/resolution.cpp
  src/sim/scene/scene.cpp
  src/sim/scene/shapes.cpp
  src/sim/scene/warnings.cpp
)
target_link_libraries(fiber_proximity_sim_scene
  PUBLIC fiber_proximity_environment_scene fiber_proximity_sim PRIVATE fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_sim_scene ${yaml_headers})
fiber_proximity_compile_fast(fiber_proximity_environment_scene fiber_proximity_sim_scene)
