# What is around the fibres, over FCL, and its YAML files: a library of its own, so that the core needs neither.

find_package(fcl 0.6 REQUIRED CONFIG)  # older ones have another interface
find_package(yaml-cpp REQUIRED)
# Its CMake package differs from version to version.
find_path(ASSIMP_INCLUDE_FOLDER assimp/scene.h)
find_library(ASSIMP_LIBRARY assimp)
if(NOT ASSIMP_INCLUDE_FOLDER OR NOT ASSIMP_LIBRARY)
  message(FATAL_ERROR "assimp is not installed (libassimp-dev): it reads meshes")
endif()
set(yaml_headers ${core_headers} <yaml-cpp/yaml.h>)

add_library(fiber_proximity_environment SHARED
  src/environment/allowed_contacts.cpp
  src/environment/check_fibers.cpp
  src/environment/convex_solids.cpp
  src/environment/environment.cpp
  src/environment/environment_motion.cpp
  src/environment/mesh_topology.cpp
  src/environment/moving_shapes.cpp
  src/environment/obstacle_parts.cpp
  src/environment/occupancy_octree.cpp
  src/environment/shape_contact_time.cpp
  src/environment/shape_boxes.cpp
  src/environment/shape_motion.cpp
  src/environment/shapes.cpp
  src/environment/triangle_distance.cpp
  src/environment/triangle_mesh.cpp
  src/environment/world.cpp
)
target_link_libraries(fiber_proximity_environment
  PUBLIC fiber_proximity yaml-cpp PRIVATE fcl ${ASSIMP_LIBRARY} fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_environment ${fcl_headers})
fiber_proximity_component(environment fiber_proximity_environment)

# Its files: compiled apart, as nothing in them takes time.
add_library(environment_scene OBJECT
  src/environment/scene/environment_scene.cpp
  src/environment/scene/mesh_files.cpp
  src/yaml/yaml_field.cpp
)
set_target_properties(environment_scene PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(environment_scene SYSTEM PRIVATE ${ASSIMP_INCLUDE_FOLDER})
target_link_libraries(environment_scene PRIVATE Eigen3::Eigen yaml-cpp fiber_proximity_options)
fiber_proximity_parse_once(environment_scene ${yaml_headers})
fiber_proximity_compile_fast(environment_scene)
target_sources(fiber_proximity_environment PRIVATE $<TARGET_OBJECTS:environment_scene>)
