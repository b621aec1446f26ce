# fiber_bench: our engines beside others, and what accuracy costs.

include(cmake/peers.cmake)
fiber_proximity_tool(fiber_bench benchmark/fiber_bench.cpp
  benchmark/accuracy.cpp benchmark/accuracy_settings.cpp benchmark/agreement.cpp
  benchmark/coherence.cpp benchmark/copies.cpp benchmark/device.cpp benchmark/device_candidates.cpp
  benchmark/environment.cpp benchmark/environment/arm.cpp benchmark/environment/camera_cloud.cpp
  benchmark/environment/capsule_mesh.cpp benchmark/environment/cell.cpp
  benchmark/environment/cell_difference.cpp benchmark/environment/fcl_checker.cpp
  benchmark/environment/fcl_shapes.cpp benchmark/environment/measure_batch.cpp
  benchmark/environment/measure_cell.cpp benchmark/environment/measure_octree.cpp
  benchmark/environment/own_checker.cpp benchmark/kernels.cpp
  benchmark/continuous/fiber_ways.cpp benchmark/continuous/measure_accuracy.cpp benchmark/continuous/measure_scenes.cpp
  benchmark/continuous/measure_times.cpp benchmark/continuous/scene_motions.cpp
  benchmark/measured_scene.cpp benchmark/measurement.cpp benchmark/motions.cpp benchmark/report.cpp benchmark/scene_commands.cpp
  benchmark/scene_options.cpp benchmark/sim/cable_judge.cpp benchmark/sim/cable_run.cpp
  benchmark/sim/cable_scene.cpp benchmark/sim/effect_costs.cpp benchmark/sim/effect_scene.cpp
  benchmark/sim/hose.cpp benchmark/sim/loads.cpp
  benchmark/sim/measurements.cpp benchmark/sim/own_cables.cpp benchmark/sim/peers.cpp
  benchmark/sim/tip_truth.cpp benchmark/sim/validation.cpp benchmark/sim/xpbd_rod.cpp
  benchmark/simulate.cpp benchmark/stages.cpp benchmark/swapped_places.cpp
  benchmark/swaying.cpp)
target_link_libraries(fiber_bench fiber_proximity_accuracy fiber_bench_peers validation_geometry validation_sim
  fiber_proximity_paper fiber_proximity_cuda fiber_proximity_scenes fiber_proximity_environment fcl)
if(FIBER_PROXIMITY_BUILD_ROS)
  target_sources(fiber_bench PRIVATE benchmark/latency.cpp benchmark/obstacle_latency.cpp)
  target_compile_definitions(fiber_bench PRIVATE FIBER_BENCH_HAS_LATENCY)
  target_include_directories(fiber_bench SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_link_libraries(fiber_bench ${catkin_LIBRARIES})
  add_dependencies(fiber_bench ${PROJECT_NAME}_generate_messages_cpp)
endif()
fiber_proximity_parse_once(fiber_bench ${tool_headers})
