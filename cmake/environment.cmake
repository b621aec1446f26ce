# What is around the fibres, over FCL: a library of its own, so that the core does not need it.

add_library(fiber_proximity_environment SHARED
  src/environment/allowed_contacts.cpp
  src/environment/allowed_parts.cpp
  src/environment/axis_distance.cpp
  src/environment/check_fibers.cpp
  src/environment/check_motions.cpp
  src/environment/environment.cpp
  src/environment/environment_motion.cpp
  src/environment/environment_query.cpp
  src/environment/mesh_topology.cpp
  src/environment/object_path.cpp
  src/environment/obstacle_parts.cpp
  src/environment/occupancy_octree.cpp
  src/environment/path_collector.cpp
  src/environment/point_distance.cpp
  src/environment/shape_box.cpp
  src/environment/shape_contact_time.cpp
  src/environment/shape_motion.cpp
  src/environment/shapes.cpp
  src/environment/triangle_distance.cpp
  src/environment/triangle_mesh.cpp
  src/environment/world.cpp
)
target_link_libraries(fiber_proximity_environment
  PUBLIC fiber_proximity PRIVATE fcl fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_environment ${fcl_headers})
