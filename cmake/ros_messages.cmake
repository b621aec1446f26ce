# Messages, services and dynamic parameters; declares the catkin package.

include(cmake/python.cmake)

set(ros_dependencies
  diagnostic_msgs
  diagnostic_updater
  dynamic_reconfigure
  geometry_msgs
  interactive_markers
  nav_msgs
  nodelet
  pluginlib
  rosgraph_msgs
  roscpp
  roslib
  sensor_msgs
  shape_msgs
  std_msgs
  std_srvs
  tf2
  tf2_ros
  urdf
  visualization_msgs
)
find_package(catkin REQUIRED COMPONENTS message_generation ${ros_dependencies})

add_message_files(FILES
  AllowedPair.msg
  Capsule.msg
  Comparison.msg
  Contact.msg
  ContactArray.msg
  ContactEvent.msg
  ContactForce.msg
  Crossing.msg
  CrossingArray.msg
  Disagreement.msg
  FclComparison.msg
  FiberArray.msg
  ForceArray.msg
  HoldForce.msg
  HoldTrajectory.msg
  InputStatistics.msg
  JointForce.msg
  LoadForce.msg
  Obstacle.msg
  ObstacleArray.msg
  PredictedContact.msg
  PredictedForce.msg
  PredictedTouch.msg
  QueryShape.msg
  SettingMeasurement.msg
  SimulationParameter.msg
  Statistics.msg
  TimeToContact.msg
)
add_service_files(FILES
  AllowPairs.srv
  ApplyObstacles.srv
  AttachFiber.srv
  CheckFibers.srv
  CompareWithFcl.srv
  DetachFiber.srv
  MeasureSettings.srv
  Predict.srv
  QueryProximity.srv
  SetSimulationParameters.srv
  StepSimulation.srv
)
generate_messages(DEPENDENCIES geometry_msgs shape_msgs std_msgs)
# The environment that tests run in is a snapshot, taken before the directory of the messages' Python
# modules exists, which is why it would be left out. catkin_python_setup takes another one, too.
file(MAKE_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${PYTHON_INSTALL_DIR})
safe_execute_process(COMMAND ${GENERATE_ENVIRONMENT_CACHE_COMMAND})
generate_dynamic_reconfigure_options(cfg/Proximity.cfg)
# One file tells what nodes offer: Proximity.cfg reads it, and so does what makes the nodes' table of parameters.
set(interface ${PROJECT_SOURCE_DIR}/cfg/interface.yaml)
add_custom_command(OUTPUT ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_INCLUDE_DESTINATION}/ProximityConfig.h
  APPEND DEPENDS ${interface})
set(interface_table ${PROJECT_BINARY_DIR}/generated/interface_table.cpp)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/generated)
add_custom_command(OUTPUT ${interface_table}
  COMMAND ${PYTHON_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/make_reference.py --table ${interface_table}
  DEPENDS ${interface} ${PROJECT_SOURCE_DIR}/scripts/make_reference.py
  COMMENT "Making the table of parameters")

# Who asks for components gets them without catkin, which makes a workspace of each project it is found by. It takes
# the package's own template of its configuration: here its own one with a few lines before.
set(${PROJECT_NAME}_EXTRAS_DIR ${PROJECT_BINARY_DIR}/generated)
file(READ ${catkin_EXTRAS_DIR}/templates/pkgConfig.cmake.in catkins_configuration)
file(WRITE ${${PROJECT_NAME}_EXTRAS_DIR}/${PROJECT_NAME}Config.cmake.in
  "if(${PROJECT_NAME}_FIND_COMPONENTS)
  include(\${CMAKE_CURRENT_LIST_DIR}/${PROJECT_NAME}-components.cmake)
  return()
endif()

${catkins_configuration}")

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES fiber_proximity_ros fiber_proximity_sim fiber_proximity_compare
    fiber_proximity_environment fiber_proximity_paper fiber_proximity_cuda fiber_proximity_scenes fiber_proximity
  CATKIN_DEPENDS message_runtime ${ros_dependencies}
  DEPENDS EIGEN3
  CFG_EXTRAS fiber_proximity-components.cmake
)
