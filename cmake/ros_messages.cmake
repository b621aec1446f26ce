# Messages, services and dynamic parameters; declares the catkin package.

include(cmake/python.cmake)

set(ros_dependencies
  diagnostic_msgs
  diagnostic_updater
  dynamic_reconfigure
  geometry_msgs
  nav_msgs
  nodelet
  pluginlib
  roscpp
  sensor_msgs
  std_msgs
  tf2
  tf2_ros
  visualization_msgs
)
find_package(catkin REQUIRED COMPONENTS message_generation ${ros_dependencies})

add_message_files(FILES
  Contact.msg
  ContactArray.msg
  FiberArray.msg
  InputStatistics.msg
  QueryShape.msg
  Statistics.msg
)
add_service_files(FILES QueryProximity.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)
generate_dynamic_reconfigure_options(cfg/Proximity.cfg)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES fiber_proximity
  CATKIN_DEPENDS message_runtime ${ros_dependencies}
  DEPENDS EIGEN3
)
