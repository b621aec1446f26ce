# Nodes, nodelets, launch files, and what a catkin workspace installs.

add_library(fiber_proximity_ros SHARED
  src/ros/detection/budget.cpp
  src/ros/detection/detector.cpp
  src/ros/detection/environment_detector.cpp
  src/ros/detection/fiber_step.cpp
  src/ros/detection/knowledge.cpp
  src/ros/detection/motion_detector.cpp
  src/ros/detection/object_forecast.cpp
  src/ros/detection/observed_scene.cpp
  src/ros/detection/predictor.cpp
  src/ros/detection/step_contacts.cpp
  src/ros/detection/uncertainty.cpp
  src/ros/environment/allowed_pairs_service.cpp
  src/ros/environment/cloud_cells.cpp
  src/ros/environment/cloud_input.cpp
  src/ros/environment/environment_inputs.cpp
  src/ros/environment/environment_options.cpp
  src/ros/environment/marker_obstacles.cpp
  src/ros/environment/mesh_loader.cpp
  src/ros/environment/object_tracks.cpp
  src/ros/environment/obstacle_change.cpp
  src/ros/environment/obstacle_service.cpp
  src/ros/environment/obstacle_set.cpp
  src/ros/environment/owed_changes.cpp
  src/ros/environment/robot_links.cpp
  src/ros/environment/waiting_changes.cpp
  src/ros/inputs/closed_fibers.cpp
  src/ros/inputs/fiber_speeds.cpp
  src/ros/inputs/fixed_frame.cpp
  src/ros/inputs/input.cpp
  src/ros/inputs/input_budget.cpp
  src/ros/inputs/input_set.cpp
  src/ros/inputs/input_source.cpp
  src/ros/inputs/input_stamps.cpp
  src/ros/inputs/marker_fibers.cpp
  src/ros/inputs/marker_input.cpp
  src/ros/inputs/merged_fibers.cpp
  src/ros/inputs/message_log.cpp
  src/ros/inputs/message_reader.cpp
  src/ros/inputs/missing_points.cpp
  src/ros/inputs/point_messages.cpp
  src/ros/inputs/publishers.cpp
  src/ros/inputs/segment_welder.cpp
  src/ros/inputs/stamp_matcher.cpp
  src/ros/inputs/synchronizer.cpp
  src/ros/inputs/transform_queue.cpp
  src/ros/outputs/answer_text.cpp
  src/ros/outputs/comparison_output.cpp
  src/ros/outputs/contact_output.cpp
  src/ros/outputs/crossings_output.cpp
  src/ros/outputs/environment_markers.cpp
  src/ros/outputs/label_place.cpp
  src/ros/outputs/marker_canvas.cpp
  src/ros/outputs/marker_output.cpp
  src/ros/outputs/markers.cpp
  src/ros/outputs/node_reports.cpp
  src/ros/outputs/tube_mesh.cpp
  src/ros/player/fiber_player.cpp
  src/ros/server/accuracy_preset.cpp
  src/ros/server/answer_pipeline.cpp
  src/ros/server/asked_config.cpp
  src/ros/server/check_service.cpp
  src/ros/server/measure_service.cpp
  src/ros/server/proximity_server.cpp
  src/ros/server/query_options.cpp
  src/ros/server/query_services.cpp
  src/ros/server/server_options.cpp
  src/ros/server/settings.cpp
  src/ros/sim/sim_forces.cpp
  src/ros/sim/sim_frames.cpp
  src/ros/sim/predict_service.cpp
  src/ros/sim/sim_markers.cpp
  src/ros/sim/sim_obstacles.cpp
  src/ros/sim/sim_server.cpp
  src/ros/sim/sim_services.cpp
  src/ros/support/conversions.cpp
  src/ros/support/parameters.cpp
  src/ros/support/stamps.cpp
  src/ros/support/unknown.cpp
)
# The generated messages' headers, as the system's: our warnings are not meant for them.
#catkin_lint: ignore_once external_directory
#catkin_lint: ignore_once external_interface_path
target_include_directories(fiber_proximity_ros SYSTEM PUBLIC
  ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION} ${catkin_INCLUDE_DIRS})
target_link_libraries(fiber_proximity_ros
  PUBLIC fiber_proximity_sim fiber_proximity_compare fiber_proximity_paper fiber_proximity_cuda fiber_proximity_scenes ${catkin_LIBRARIES}
  PRIVATE fiber_proximity_accuracy fiber_proximity_options)
# What does something for each contact is worth -O3, alone among sources that hand on what others compute.
set_source_files_properties(
  src/ros/detection/step_contacts.cpp src/ros/outputs/contact_output.cpp src/ros/support/conversions.cpp
  PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_UNITY_BUILD_INCLUSION ON)
# ROS's headers take half of the time of such a source, also of a dozen together.
fiber_proximity_compile_together(fiber_proximity_ros)
fiber_proximity_precompile(fiber_proximity_ros ${ros_headers})
target_sources(fiber_proximity_ros PRIVATE ${interface_table}) # not there yet to be read for what is compiled together
# Not all exported targets: messages in other languages need not be there first.
add_dependencies(fiber_proximity_ros
  ${PROJECT_NAME}_generate_messages_cpp ${PROJECT_NAME}_gencfg)

add_executable(fiber_player src/nodes/fiber_player.cpp)
target_link_libraries(fiber_player fiber_proximity_ros fiber_proximity_options)

add_executable(proximity_node src/nodes/proximity_node.cpp)
target_link_libraries(proximity_node fiber_proximity_ros fiber_proximity_options)

add_executable(cable_sim src/nodes/cable_sim.cpp)
target_link_libraries(cable_sim fiber_proximity_ros fiber_proximity_options)

add_library(fiber_proximity_nodelets SHARED src/nodes/nodelets.cpp)
target_link_libraries(fiber_proximity_nodelets
  PUBLIC fiber_proximity_ros PRIVATE fiber_proximity_options)

fiber_proximity_compile_fast(
  fiber_proximity_ros fiber_proximity_nodelets fiber_player proximity_node cable_sim)

install(TARGETS fiber_proximity_ros fiber_proximity_nodelets
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION}
)
install(TARGETS fiber_player proximity_node cable_sim
  RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY config launch meshes rviz urdf DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
catkin_install_python(PROGRAMS
  examples/python/guard_robot.py
  scripts/end_simulated_time.py scripts/play_arm.py scripts/play_cell.py scripts/play_joined.py
  scripts/play_passing.py scripts/play_tracker.py scripts/print_contacts.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
