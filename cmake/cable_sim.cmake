# The node that runs scenes of the simulation.

add_library(fiber_proximity_cable_sim SHARED
  src/ros/sim/force_markers.cpp
  src/ros/sim/sim_forces.cpp
  src/ros/sim/sim_frames.cpp
  src/ros/sim/sim_markers.cpp
  src/ros/sim/sim_server.cpp
  src/ros/sim/sim_services.cpp
)
target_link_libraries(fiber_proximity_cable_sim
  PUBLIC fiber_proximity_ros fiber_proximity_sim_scene PRIVATE fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_cable_sim ${ros_headers})

add_executable(cable_sim src/nodes/cable_sim.cpp)
target_link_libraries(cable_sim fiber_proximity_cable_sim fiber_proximity_options)

add_library(fiber_proximity_nodelets SHARED src/nodes/nodelets.cpp)
target_link_libraries(fiber_proximity_nodelets
  PUBLIC fiber_proximity_cable_sim PRIVATE fiber_proximity_options)
fiber_proximity_compile_fast(fiber_proximity_cable_sim cable_sim fiber_proximity_nodelets)

install(TARGETS fiber_proximity_sim fiber_proximity_sim_scene fiber_proximity_cable_sim
    fiber_proximity_nodelets
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION}
)
install(TARGETS cable_sim RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
