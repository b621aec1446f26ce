# Most of the time that a first build takes goes into parsing headers, again for each source. Two ways to
# parse them once for many: several sources of a folder compiled as one, and precompiled headers.

# Helpers in unnamed namespaces have names of their own within a folder, as the sources of a folder share
# them. Whoever changes sources one by one turns this off.
option(FIBER_PROXIMITY_UNITY_BUILD "Compile several sources of a folder as one" ON)
option(FIBER_PROXIMITY_PRECOMPILE_HEADERS "Parse common headers once a target" ON)
if(CMAKE_VERSION VERSION_LESS 3.18)
  set(FIBER_PROXIMITY_UNITY_BUILD OFF)  # sources cannot be grouped
endif()

set(core_headers
  <algorithm> <array> <cmath> <cstdint> <functional> <limits> <memory> <optional> <random> <stdexcept>
  <string> <utility> <vector> <Eigen/Geometry>)
set(fcl_headers ${core_headers} <fcl/fcl.h>)
set(ros_headers ${core_headers}
  <ros/ros.h> <tf2_ros/buffer.h> <tf2_ros/transform_listener.h> <sensor_msgs/PointCloud2.h>
  <visualization_msgs/MarkerArray.h> <yaml-cpp/yaml.h>)
set(tool_headers ${core_headers} <CLI/CLI.hpp> <nlohmann/json.hpp>)

# fiber_proximity_compile_fast(TARGET...)
# For code that hands on what others compute: -O1 takes the compiler two thirds of the time of -O3.
function(fiber_proximity_compile_fast)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endforeach()
endfunction()

# fiber_proximity_compile_cold(TARGET...)
# For tests that wait for programs and nodes: -O0 takes the compiler two thirds of the time of -O1.
function(fiber_proximity_compile_cold)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE -O0)
  endforeach()
endfunction()

# fiber_proximity_precompile(TARGET HEADER...)
function(fiber_proximity_precompile target)
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# fiber_proximity_compile_together(TARGET)
# Compiles the target's sources together, those of a folder at once, if sources are not compiled one by
# one. Those that Highway compiles once for each instruction set stay alone: they include themselves.
function(fiber_proximity_compile_together target)
  if(NOT FIBER_PROXIMITY_UNITY_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "\\.cpp$")
      continue()
    endif()
    file(STRINGS ${source} alone REGEX "HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    if(alone)
      continue()
    endif()
    get_filename_component(folder ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER "in_${folder}" folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${target}_${folder})
  endforeach()
endfunction()

# fiber_proximity_parse_once(TARGET HEADER...)
# All sources of a folder at once; if sources are compiled one by one, precompiles these
# headers.
function(fiber_proximity_parse_once target)
  fiber_proximity_compile_together(${target})
  if(NOT FIBER_PROXIMITY_UNITY_BUILD)
    fiber_proximity_precompile(${target} ${ARGN})
  endif()
endfunction()
