# The fuzzers of what reads YAML, meshes and messages, where ROS is found.

set(message_packages geometry_msgs nav_msgs sensor_msgs shape_msgs std_msgs visualization_msgs)
set(library_packages geometric_shapes roscpp roslib tf2_ros)
foreach(package gencpp ${message_packages} ${library_packages})
  find_package(${package} QUIET CONFIG)
  if(NOT ${package}_FOUND)
    message(STATUS "${package} is not installed: only files without ROS are fuzzed")
    return()
  endif()
  include_directories(SYSTEM ${${package}_INCLUDE_DIRS})
endforeach()
find_package(yaml-cpp REQUIRED)
find_package(fcl 0.6 REQUIRED CONFIG)
find_package(hwy REQUIRED)
find_package(TBB REQUIRED)

# Headers of our messages and services, without catkin.
find_program(python NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
set(includes -Ifiber_proximity:${root}/msg)
foreach(package ${message_packages})
  list(APPEND includes -I${package}:${${package}_DIR}/../msg)
endforeach()
set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
set(headers)
file(GLOB definitions CONFIGURE_DEPENDS ${root}/msg/*.msg ${root}/srv/*.srv)
foreach(definition ${definitions})
  get_filename_component(name ${definition} NAME_WE)
  set(header ${generated}/fiber_proximity/${name}.h)
  add_custom_command(OUTPUT ${header}
    COMMAND ${python} ${GENCPP_BIN} ${definition} ${includes} -p fiber_proximity
      -o ${generated}/fiber_proximity -e ${GENCPP_TEMPLATE_DIR}
    DEPENDS ${definition})
  list(APPEND headers ${header})
endforeach()
add_custom_target(message_headers DEPENDS ${headers})
include_directories(SYSTEM ${generated})

# unwatched_library(NAME SOURCE...)
# What is behind the reading, without sanitizers: with them it compiles four times as long. Highway's
# kernels are compiled once, for the oldest processor.
function(unwatched_library name)
  list(TRANSFORM ARGN PREPEND ${root}/)
  add_library(${name} STATIC ${ARGN})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 20)
  foreach(source ${ARGN})
    file(STRINGS ${source} kernel REGEX HWY_TARGET_INCLUDE)
    if(kernel)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  target_compile_definitions(${name} PRIVATE HWY_COMPILE_ONLY_STATIC)
  target_link_libraries(${name} PUBLIC Eigen3::Eigen)
endfunction()

unwatched_library(fiber_queries
  src/environment/axis_distance.cpp
  src/environment/environment.cpp
  src/environment/environment_query.cpp
  src/environment/point_distance.cpp
  src/environment/triangle_distance.cpp
  src/geometry/contact_times.cpp
  src/geometry/exact_distance.cpp
  src/geometry/exact_numbers.cpp
  src/geometry/fast_segment_distances.cpp
  src/geometry/kernel.cpp
  src/geometry/rounded_distance.cpp
  src/geometry/segment_distance.cpp
  src/geometry/segment_distances.cpp
  src/geometry/smallest_rotation.cpp
  src/geometry/swept_fibers.cpp
  src/geometry/wide_contact_time.cpp
  src/bounds/bounding_volume.cpp
  src/hierarchy/fiber_order.cpp
  src/hierarchy/run_tree_find.cpp
  src/hierarchy/sort_keys.cpp
  src/query/brute_force.cpp
  src/query/contact.cpp
  src/query/contact_batch.cpp
  src/query/contact_judge.cpp
  src/query/contact_keeper.cpp
  src/query/engine.cpp
  src/query/fiber_pair_minima.cpp
  src/query/loop_free_stretches.cpp
  src/query/loop_test.cpp
  src/query/motion.cpp
  src/query/motion_judge.cpp
  src/query/options.cpp
  src/query/pair_collector.cpp
  src/query/pair_test.cpp
  src/query/point_boxes.cpp
  src/query/threads.cpp
)
target_link_libraries(fiber_queries PUBLIC fuzzed_io fcl TBB::tbb hwy::hwy hwy::hwy_contrib)

fuzzed_library(fuzzed_messages UNITY 4
  src/ros/chain_set.cpp
  src/ros/cloud_cells.cpp
  src/ros/conversions.cpp
  src/ros/marker_input.cpp
  src/ros/missing_points.cpp
  src/ros/obstacle_change.cpp
  src/ros/obstacle_pose.cpp
  src/ros/obstacle_shapes.cpp
  src/ros/point_cloud_input.cpp
  src/ros/pose_input.cpp
  src/ros/segment_welder.cpp
)
fuzzed_library(fuzzed_shapes UNITY 4
  src/environment/mesh_topology.cpp
  src/environment/occupancy_octree.cpp
  src/environment/shape_box.cpp
  src/environment/shapes.cpp
  src/environment/triangle_mesh.cpp
  src/environment/world.cpp
)
add_dependencies(fuzzed_messages message_headers)
target_link_libraries(fuzzed_shapes PUBLIC fiber_queries)
target_link_libraries(fuzzed_messages PUBLIC fuzzed_shapes ${roscpp_LIBRARIES})
fuzz_target(messages fuzzed_messages)

fuzzed_library(fuzzed_yaml UNITY 4
  src/ros/allowed_contacts.cpp
  src/ros/environment_scene.cpp
  src/ros/load_yaml.cpp
  src/ros/mesh_loader.cpp
  src/ros/obstacle_set.cpp
  src/ros/parse_mesh.cpp
  src/ros/yaml_field.cpp
  src/ros/yaml_obstacle.cpp
)
unwatched_library(waiting_changes
  src/ros/fixed_frame.cpp
  src/ros/touched_objects.cpp
  src/ros/waiting_changes.cpp
  src/ros/worker.cpp
)
target_link_libraries(waiting_changes PUBLIC fuzzed_io ${tf2_ros_LIBRARIES})
target_link_libraries(fuzzed_yaml PUBLIC
  fuzzed_messages waiting_changes yaml-cpp ${geometric_shapes_LIBRARIES} ${roslib_LIBRARIES})
fuzz_target(obstacles fuzzed_yaml)

file(GLOB simulation RELATIVE ${root} CONFIGURE_DEPENDS
  ${root}/src/sim/*.cpp ${root}/src/sim/effects/*.cpp)
unwatched_library(simulation ${simulation})
target_link_libraries(simulation PUBLIC fiber_queries)
target_sources(simulation PRIVATE engine.cpp)
fuzzed_library(fuzzed_scenes UNITY 6
  src/ros/sim_effects.cpp
  src/ros/sim_fibers.cpp
  src/ros/sim_holds.cpp
  src/ros/sim_natural_curvature.cpp
  src/ros/sim_overlap.cpp
  src/ros/sim_parameters.cpp
  src/ros/sim_resolution.cpp
  src/ros/sim_scene.cpp
  src/ros/sim_shapes.cpp
)
target_link_libraries(fuzzed_scenes PUBLIC fuzzed_yaml simulation)
fuzz_target(scenes fuzzed_scenes)
fuzz_target(meshes fuzzed_yaml)
