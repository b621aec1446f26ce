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
# What is behind the reading, without sanitizers: with them it compiles four times as long. A folder is compiled
# as one. Highway's kernels are compiled once, for the oldest processor.
function(unwatched_library name)
  list(TRANSFORM ARGN PREPEND ${root}/)
  add_library(${name} STATIC ${ARGN})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source ${ARGN})
    get_filename_component(folder ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER ${folder} folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
    file(STRINGS ${source} kernel REGEX HWY_TARGET_INCLUDE)
    if(kernel)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  target_compile_definitions(${name} PRIVATE HWY_COMPILE_ONLY_STATIC)
  target_link_libraries(${name} PUBLIC Eigen3::Eigen)
endfunction()

set(shapes
  src/environment/allowed_contacts.cpp
  src/environment/mesh_topology.cpp
  src/environment/obstacle_parts.cpp
  src/environment/occupancy_octree.cpp
  src/environment/shapes.cpp
  src/environment/triangle_mesh.cpp
  src/environment/world.cpp
)
sources_in(queries environment geometry hierarchy query)
list(REMOVE_ITEM queries ${shapes} src/geometry/fiber_assembly.cpp src/geometry/fiber_graph.cpp)
list(FILTER queries EXCLUDE REGEX "_engines?.cpp|engine_factory|candidate_cache")  # see engine.cpp
unwatched_library(fiber_queries ${queries})
target_sources(fiber_queries PRIVATE engine.cpp)
target_link_libraries(fiber_queries PUBLIC fuzzed_io fcl TBB::tbb hwy::hwy hwy::hwy_contrib)

fuzzed_library(fuzzed_shapes UNITY 4 ${shapes})
target_link_libraries(fuzzed_shapes PUBLIC fiber_queries)

sources_in(yaml environment/scene yaml)
fuzzed_library(fuzzed_yaml UNITY 4 ${yaml})
target_include_directories(fuzzed_yaml SYSTEM PRIVATE ${ASSIMP_INCLUDE_FOLDER})
target_link_libraries(fuzzed_yaml PUBLIC fuzzed_shapes yaml-cpp ${ASSIMP_LIBRARY})
fuzz_target(obstacles fuzzed_yaml)
fuzz_target(meshes fuzzed_yaml)

sources_in(simulation sim sim/contact sim/effects sim/joint sim/solver)
unwatched_library(simulation ${simulation})
target_link_libraries(simulation PUBLIC fiber_queries)
sources_in(sim_scene sim/scene)
fuzzed_library(fuzzed_scenes UNITY 6 ${sim_scene})
target_link_libraries(fuzzed_scenes PUBLIC fuzzed_yaml simulation)
fuzz_target(scenes fuzzed_scenes)
