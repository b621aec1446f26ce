# The fuzzers of what reads scenes and meshes, where what they need is found.

foreach(package yaml-cpp fcl hwy TBB)
  find_package(${package} QUIET CONFIG)
endforeach()
find_path(ASSIMP_INCLUDE_FOLDER assimp/scene.h)
find_library(ASSIMP_LIBRARY assimp)
if(NOT yaml-cpp_FOUND OR NOT fcl_FOUND OR NOT hwy_FOUND OR NOT TBB_FOUND OR NOT ASSIMP_LIBRARY)
  message(STATUS "yaml-cpp, FCL, Highway, TBB or assimp is not installed: no scenes are fuzzed")
  return()
endif()

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
  src/environment/allowed_parts.cpp
  src/environment/axis_distance.cpp
  src/environment/environment.cpp
  src/environment/environment_query.cpp
  src/environment/object_path.cpp
  src/environment/point_distance.cpp
  src/environment/shape_contact_time.cpp
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
  src/geometry/wide_gap.cpp
  src/bounds/bounding_volume.cpp
  src/hierarchy/fiber_order.cpp
  src/hierarchy/run_tree_find.cpp
  src/hierarchy/sort_keys.cpp
  src/query/brute_force.cpp
  src/query/contact.cpp
  src/query/contact_batch.cpp
  src/query/contact_in_motion.cpp
  src/query/contact_judge.cpp
  src/query/contact_keeper.cpp
  src/query/engine.cpp
  src/query/fiber_pair_minima.cpp
  src/query/loop_free_stretches.cpp
  src/query/loop_test.cpp
  src/query/motion.cpp
  src/query/motion_judge.cpp
  src/query/motion_slices.cpp
  src/query/options.cpp
  src/query/pair_collector.cpp
  src/query/pair_test.cpp
  src/query/point_boxes.cpp
  src/query/threads.cpp
)
target_link_libraries(fiber_queries PUBLIC fuzzed_io fcl TBB::tbb hwy::hwy hwy::hwy_contrib)

fuzzed_library(fuzzed_shapes UNITY 4
  src/environment/allowed_contacts.cpp
  src/environment/mesh_topology.cpp
  src/environment/obstacle_parts.cpp
  src/environment/occupancy_octree.cpp
  src/environment/shape_box.cpp
  src/environment/shapes.cpp
  src/environment/triangle_mesh.cpp
  src/environment/world.cpp
)
target_link_libraries(fuzzed_shapes PUBLIC fiber_queries)

fuzzed_library(fuzzed_yaml UNITY 4
  src/environment/scene/environment_scene.cpp
  src/environment/scene/mesh_files.cpp
  src/environment/scene/parse_mesh.cpp
  src/yaml/load_yaml.cpp
  src/yaml/yaml_field.cpp
)
target_include_directories(fuzzed_yaml SYSTEM PRIVATE ${ASSIMP_INCLUDE_FOLDER})
target_link_libraries(fuzzed_yaml PUBLIC fuzzed_shapes yaml-cpp ${ASSIMP_LIBRARY})
fuzz_target(obstacles fuzzed_yaml)
fuzz_target(meshes fuzzed_yaml)

file(GLOB simulation RELATIVE ${root} CONFIGURE_DEPENDS
  ${root}/src/sim/*.cpp ${root}/src/sim/contact/*.cpp ${root}/src/sim/effects/*.cpp
  ${root}/src/sim/solver/*.cpp)
unwatched_library(simulation ${simulation})
target_link_libraries(simulation PUBLIC fiber_queries)
target_sources(simulation PRIVATE engine.cpp)
file(GLOB sim_scene RELATIVE ${root} CONFIGURE_DEPENDS ${root}/src/sim/scene/*.cpp)
fuzzed_library(fuzzed_scenes UNITY 6 ${sim_scene})
target_link_libraries(fuzzed_scenes PUBLIC fuzzed_yaml simulation)
fuzz_target(scenes fuzzed_scenes)
