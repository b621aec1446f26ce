# Nodes and displays, with a ROS master or without; included from test/, where paths begin.

# Of those that read ROS's headers, which takes most of the time of such a test.
fiber_proximity_test_headers(graph_test_headers cold fiber_proximity_ros ${ros_headers})

fiber_proximity_gtest(tube_mesh_test ros/tube_mesh_test.cpp LIBRARIES fiber_proximity_ros)
fiber_proximity_gtest(markers_test
  ros/answer_text_test.cpp
  ros/crossing_markers_test.cpp
  ros/environment_markers_test.cpp
  ros/label_place_test.cpp
  ros/marker_texts_test.cpp
  ros/markers_test.cpp
  ros/shape_marker_test.cpp
  COLD
  HEADERS graph_test_headers
  LIBRARIES fiber_proximity_ros
)
fiber_proximity_gtest(conversions_test
  ros/closed_fibers_test.cpp
  ros/conversions_test.cpp
  ros/kept_markers_test.cpp
  ros/marker_input_test.cpp
  ros/merged_fibers_test.cpp
  ros/missing_points_test.cpp
  COLD
  HEADERS graph_test_headers
  LIBRARIES fiber_proximity_ros
)
if(NOT FIBER_PROXIMITY_SANITIZE)
  # On its own: it replaces operator new.
  fiber_proximity_gtest(input_allocation_test
    ros/input_allocation_test.cpp
    LIBRARIES fiber_proximity_ros
  )
endif()
fiber_proximity_gtest(stamps_test
  ros/publishers_test.cpp
  ros/stamp_matcher_test.cpp
  COLD
  HEADERS graph_test_headers
  LIBRARIES fiber_proximity_ros
)
fiber_proximity_gtest(detector_test
  ros/budget_test.cpp
  ros/detector_test.cpp
  ros/fiber_step_test.cpp
  ros/uncertain_motion_test.cpp
  ros/uncertainty_test.cpp
  COLD
  HEADERS graph_test_headers
  LIBRARIES fiber_proximity_paper fiber_proximity_ros
)
fiber_proximity_gtest(environment_inputs_test
  ros/cloud_cells_test.cpp
  ros/mesh_loader_test.cpp
  ros/obstacle_change_test.cpp
  ros/robot_links_test.cpp
  ros/scene_parameter_test.cpp
  COLD
  HEADERS graph_test_headers
  LIBRARIES fiber_proximity_ros
)
find_package(octomap QUIET)  # of which the tests make maps
if(TARGET fiber_proximity_octomap AND octomap_FOUND)
  fiber_proximity_gtest(octomap_cloud_test
    ros/octomap_cloud_test.cpp
    LIBRARIES fiber_proximity_octomap ${OCTOMAP_LIBRARIES}
  )
endif()
if(TARGET fiber_proximity_moveit)
  fiber_proximity_gtest(planning_scene_test
    ros/planning_scene_test.cpp
    LIBRARIES fiber_proximity_moveit
  )
endif()
fiber_proximity_gtest(input_options_test
  ros/input_budget_test.cpp
  ros/input_options_test.cpp
  COLD
  HEADERS graph_test_headers
  LIBRARIES fiber_proximity_ros
)
fiber_proximity_gtest(fiber_mesh_test
  rviz/answer_history_test.cpp
  rviz/contact_pairing_test.cpp
  rviz/fiber_chunks_test.cpp
  rviz/fiber_colors_test.cpp
  rviz/fiber_detail_test.cpp
  rviz/fiber_mesh_test.cpp
  rviz/marker_texts_test.cpp
  rviz/view_fit_test.cpp
  LIBRARIES fiber_proximity_mesh
)

# The running node, through the real graph.
find_package(rostest REQUIRED)
add_library(graph_test_main STATIC EXCLUDE_FROM_ALL ros/main.cpp)
target_link_libraries(graph_test_main PRIVATE fiber_proximity_ros fiber_proximity_options ${GTEST_LIBRARIES})
fiber_proximity_compile_cold(graph_test_main)
add_executable(node_test EXCLUDE_FROM_ALL
  ros/bad_input_test.cpp
  ros/bad_parameters_test.cpp
  ros/cell_test.cpp
  ros/cloud_points_test.cpp
  ros/compare_test.cpp
  ros/continuous_bad_input_test.cpp
  ros/continuous_test.cpp
  ros/crossings_test.cpp
  ros/demo_test.cpp
  ros/draw_test.cpp
  ros/engines_test.cpp
  ros/environment_test.cpp
  ros/guard_faults_test.cpp
  ros/inputs_test.cpp
  ros/joined_test.cpp
  ros/limits_test.cpp
  ros/measure_settings_test.cpp
  ros/moving_test.cpp
  ros/no_clock_test.cpp
  ros/nodelet_test.cpp
  ros/output_topic_test.cpp
  ros/prediction_test.cpp
  ros/query_test.cpp  # first of its suite: asks before there are fibres
  ros/query_options_test.cpp
  ros/reconfigure_test.cpp
  ros/self_contact_test.cpp
  ros/sim_time_test.cpp
  ros/skin_test.cpp
  ros/soak_test.cpp
  ros/stale_test.cpp
  ros/timing_test.cpp
  ros/touches_test.cpp
  ros/tracks_test.cpp
  ros/unknown_test.cpp
)
target_compile_definitions(node_test PRIVATE PROXIMITY_NODE="$<TARGET_FILE:proximity_node>")
target_link_libraries(node_test
  graph_test_main fiber_proximity_ros fiber_proximity_options test_support ${GTEST_LIBRARIES})
add_dependencies(tests node_test)
add_custom_target(soak DEPENDS node_test proximity_node)  # for scripts/campaign.sh
foreach(name crossings draw environment inputs query unknown)
  add_rostest(ros/${name}.test DEPENDENCIES node_test proximity_node fiber_player)
  add_rostest(ros/${name}.test
    ARGS nodelet:=true DEPENDENCIES node_test fiber_proximity_nodelets fiber_player)
endforeach()
add_rostest(ros/nodelet.test DEPENDENCIES node_test fiber_proximity_nodelets)
foreach(name bad_input cell cloud_points compare continuous crossings_camera engines guard_faults joined limits
    measure_settings moving reconfigure self_contact shared_tracks sim_time skin soak stale timing tracks)
  add_rostest(ros/${name}.test DEPENDENCIES node_test proximity_node fiber_player)
endforeach()

add_rostest(ros/self_contact.test
  ARGS config:=cdcpd tests:=SelfContactOfOneTest DEPENDENCIES node_test proximity_node)

add_rostest(ros/no_clock.test DEPENDENCIES node_test proximity_node fiber_player cable_sim)
add_rostest(ros/guard_robot.test)
add_rostest(ros/relaunch.test DEPENDENCIES proximity_node)
add_rostest(ros/views.test DEPENDENCIES proximity_node fiber_player cable_sim)
add_rostest(ros/reference.test DEPENDENCIES proximity_node fiber_player cable_sim)

add_rostest_gtest(fiber_player_test ros/fiber_player.test ros/fiber_player_test.cpp)
target_link_libraries(fiber_player_test fiber_proximity_ros fiber_proximity_options)
target_compile_definitions(fiber_player_test PRIVATE
  FIBER_PLAYER="$<TARGET_FILE:fiber_player>")
add_dependencies(fiber_player_test fiber_player)

add_executable(cable_sim_test EXCLUDE_FROM_ALL
  ros/cable_sim_limits_test.cpp
  ros/cable_sim_scenes_test.cpp
  ros/cable_sim_test.cpp
  ros/sim_forces_test.cpp
  ros/sim_obstacle_topic_test.cpp
  ros/sim_obstacles_test.cpp
  ros/sim_predict_test.cpp
)
add_executable(failing_cable_sim EXCLUDE_FROM_ALL ros/failing_cable_sim.cpp)
target_link_libraries(failing_cable_sim fiber_proximity_ros fiber_proximity_options)
fiber_proximity_compile_cold(failing_cable_sim)
target_compile_definitions(cable_sim_test PRIVATE
  CABLE_SIM="$<TARGET_FILE:cable_sim>" FAILING_CABLE_SIM="$<TARGET_FILE:failing_cable_sim>")
target_link_libraries(cable_sim_test
  graph_test_main fiber_proximity_ros fiber_proximity_options ${GTEST_LIBRARIES})
add_dependencies(tests cable_sim_test failing_cable_sim)
add_rostest(ros/cable_sim.test DEPENDENCIES cable_sim_test cable_sim)
add_rostest(ros/demo.test DEPENDENCIES node_test proximity_node cable_sim)
add_rostest(ros/sim_forces.test DEPENDENCIES cable_sim_test cable_sim)
add_rostest(ros/sim_predict.test DEPENDENCIES cable_sim_test cable_sim)
add_rostest(ros/sim_frames.test DEPENDENCIES cable_sim_test cable_sim)
add_rostest(ros/sim_obstacle_nodes.test DEPENDENCIES cable_sim_test cable_sim)
add_rostest(ros/sim_obstacles.test DEPENDENCIES cable_sim_test cable_sim)
add_rostest(ros/cable_sim.test
  ARGS nodelet:=true DEPENDENCIES cable_sim_test cable_sim fiber_proximity_nodelets)

add_executable(input_node_test EXCLUDE_FROM_ALL
  ros/input_budget_node_test.cpp
  ros/missing_points_node_test.cpp
  ros/reversed_test.cpp
  ros/stamps_node_test.cpp
  ros/synchronize_node_test.cpp
)
target_link_libraries(input_node_test
  graph_test_main fiber_proximity_ros fiber_proximity_options ${GTEST_LIBRARIES})
add_dependencies(tests input_node_test)
foreach(name input_budget missing_points reversed stamps synchronize)
  add_rostest(ros/${name}.test DEPENDENCIES input_node_test proximity_node)
endforeach()

add_rostest_gtest(answer_text_node_test
  ros/answer_text.test
  ros/answer_text_node_test.cpp  # first: asks before an input has come
  ros/answer_truth_test.cpp
)
target_link_libraries(answer_text_node_test
  graph_test_main fiber_proximity_ros fiber_proximity_options test_support)
add_dependencies(answer_text_node_test proximity_node)

add_rostest_gtest(uncertainty_node_test
  ros/uncertainty.test
  ros/uncertainty_node_test.cpp
)
target_link_libraries(uncertainty_node_test
  graph_test_main fiber_proximity_ros fiber_proximity_options test_support)
add_dependencies(uncertainty_node_test proximity_node)

add_rostest_gtest(latency_node_test
  ros/latency.test
  ros/latency_node_test.cpp
)
target_link_libraries(latency_node_test
  graph_test_main fiber_proximity_ros fiber_proximity_options test_support)
add_dependencies(latency_node_test proximity_node)

add_rostest_gtest(environment_node_test
  ros/environment_inputs.test
  ros/environment_clouds_test.cpp
  ros/environment_inputs_test.cpp
  ros/environment_obstacles_test.cpp
  ros/marker_obstacles_test.cpp
  ros/waiting_changes_test.cpp
)
target_link_libraries(environment_node_test graph_test_main fiber_proximity_ros fiber_proximity_options)

# The running node without and with fibres: what it is asked about its environment.
add_rostest_gtest(environment_services_test
  ros/environment_services.test
  ros/environment_services_test.cpp  # first of its suite: asks before there are fibres
  ros/environment_updates_test.cpp
  ros/motion_services_test.cpp
)
target_link_libraries(environment_services_test graph_test_main fiber_proximity_ros fiber_proximity_options)
add_dependencies(environment_services_test proximity_node)

if(TARGET octomap_cloud_test)
  add_rostest_gtest(octomap_bridge_test
    ros/octomap_bridge.test
    ros/octomap_bridge_test.cpp
  )
  target_link_libraries(octomap_bridge_test
    graph_test_main fiber_proximity_octomap fiber_proximity_options ${OCTOMAP_LIBRARIES})
  add_dependencies(octomap_bridge_test octomap_bridge proximity_node)
endif()
if(TARGET fiber_proximity_moveit)
  add_rostest_gtest(moveit_bridge_test
    ros/moveit_bridge.test
    ros/moveit_bridge_test.cpp
  )
  target_link_libraries(moveit_bridge_test graph_test_main fiber_proximity_moveit fiber_proximity_options)
  add_dependencies(moveit_bridge_test moveit_bridge proximity_node)
endif()

if(TARGET fiber_proximity_rviz)
  foreach(name accuracy_panel display tracker_view)
    add_executable(${name}_test EXCLUDE_FROM_ALL rviz/${name}_test.cpp)
    target_link_libraries(${name}_test
      fiber_proximity_rviz fiber_proximity_options ${GTEST_LIBRARIES})
    fiber_proximity_compile_cold(${name}_test)
    add_dependencies(tests ${name}_test)
    add_rostest(rviz/${name}.test DEPENDENCIES ${name}_test)
  endforeach()
  add_dependencies(accuracy_panel_test proximity_node)
  target_compile_definitions(tracker_view_test PRIVATE
    TRACKER_VIEW="${PROJECT_SOURCE_DIR}/rviz/tracker.rviz")
endif()

if(TARGET fiber_proximity_python)
  add_rostest(ros/plot_clearances.test)
endif()

# In the environment of the devel space, as its readers.
set(tutorials ask_before_you_move attach_a_tracker guard_a_gripper my_robot_and_my_cable simulate_a_cable
  stop_the_robot two_cables)
if(FIBER_PROXIMITY_BUILD_BENCHMARKS)
  list(APPEND tutorials measure_your_own_scene)
endif()
if(TARGET fiber_proximity_python)
  list(APPEND tutorials clearance_from_a_bag fit_a_cable harness_on_an_arm plan_with_two_grippers which_setting_for_my_cable
    your_file_in_ten_lines)
endif()
list(TRANSFORM tutorials PREPEND ${PROJECT_SOURCE_DIR}/docs/tutorials/)
list(TRANSFORM tutorials APPEND .md)
# In both orders each comes after each other one, and what that has left.
add_test(NAME tutorials COMMAND ${CATKIN_ENV} /usr/bin/python3 -B
  ${CMAKE_CURRENT_SOURCE_DIR}/docs/tutorials_test.py ${tutorials})
# Minutes of a simulated arm: once is enough.
list(REMOVE_ITEM tutorials ${PROJECT_SOURCE_DIR}/docs/tutorials/harness_on_an_arm.md)
add_test(NAME tutorials_in_reverse COMMAND ${CATKIN_ENV} /usr/bin/python3 -B
  ${CMAKE_CURRENT_SOURCE_DIR}/docs/tutorials_test.py --reverse ${tutorials})
add_test(NAME setup_test COMMAND /usr/bin/python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/docs/setup_test.py
  ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR})

find_package(roslaunch REQUIRED)
roslaunch_add_file_check(../launch/cable_sim.launch)
roslaunch_add_file_check(../launch/cell.launch)
roslaunch_add_file_check(../launch/demo.launch)
roslaunch_add_file_check(../launch/guard_robot.launch distance:=0.05)
roslaunch_add_file_check(../launch/hair.launch)
roslaunch_add_file_check(../launch/arm_harness.launch)
roslaunch_add_file_check(../launch/hose.launch)
roslaunch_add_file_check(../launch/joined.launch)
roslaunch_add_file_check(../launch/known_frame.launch)
roslaunch_add_file_check(../launch/passing.launch)
roslaunch_add_file_check(../launch/proximity.launch)
roslaunch_add_file_check(../launch/tracker_example.launch)
roslaunch_add_file_check(../launch/with_tracker.launch
  frame:=world topic:=points radius:=0.01 margin:=0.02 robot:=true)
roslaunch_add_file_check(../launch/with_tracker.launch frame:=world
  config:=${PROJECT_SOURCE_DIR}/config/cdcpd.yaml)
roslaunch_add_file_check(../launch/bag.launch bag:=/tmp/any.bag frame:=world
  config:=${PROJECT_SOURCE_DIR}/config/trackdlo.yaml)

fiber_proximity_graph_tests(node_test fiber_player_test cable_sim_test input_node_test
  answer_text_node_test environment_node_test environment_services_test latency_node_test uncertainty_node_test)

# No sanitizer looks at nodes: the C library fills the memory that they free. What is read there then is wrong in each
# run, and not in one of a hundred.
get_property(tests DIRECTORY PROPERTY TESTS)
foreach(test IN LISTS tests)
  if(test MATCHES "_rostest_")
    set_tests_properties(${test} PROPERTIES ENVIRONMENT MALLOC_PERTURB_=165)
  endif()
endforeach()
