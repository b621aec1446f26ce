# The fuzzer of what reads messages, where ROS is found.

set(message_packages geometry_msgs nav_msgs sensor_msgs shape_msgs std_msgs visualization_msgs)
set(library_packages roscpp)
foreach(package gencpp ${message_packages} ${library_packages})
  find_package(${package} QUIET CONFIG)
  if(NOT ${package}_FOUND)
    message(STATUS "${package} is not installed: no messages are fuzzed")
    return()
  endif()
  include_directories(SYSTEM ${${package}_INCLUDE_DIRS})
endforeach()

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

fuzzed_library(fuzzed_messages UNITY 4
  src/ros/environment/cloud_cells.cpp
  src/ros/support/conversions.cpp
  src/ros/inputs/closed_fibers.cpp
  src/ros/inputs/marker_fibers.cpp
  src/ros/inputs/marker_input.cpp
  src/ros/inputs/missing_points.cpp
  src/ros/environment/obstacle_change.cpp
  src/ros/inputs/point_messages.cpp
  src/ros/inputs/segment_welder.cpp
)
add_dependencies(fuzzed_messages message_headers)
target_link_libraries(fuzzed_messages PUBLIC fuzzed_shapes ${roscpp_LIBRARIES})
fuzz_target(messages fuzzed_messages)
