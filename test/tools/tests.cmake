# Command line tools and benchmarks; included from test/, where paths begin.

fiber_proximity_gtest(tools_test
  accuracy/accuracy_picture_test.cpp
  accuracy/answer_errors_test.cpp
  accuracy/doubt_sources_test.cpp
  accuracy/noise_test.cpp
  accuracy/recommendation_test.cpp
  accuracy/resampling_test.cpp
  accuracy/setting_measurement_test.cpp
  tools/accuracy_command_test.cpp
  tools/bad_command_line_test.cpp
  tools/check_test.cpp
  tools/compare_test.cpp
  tools/fiber_query_engines_test.cpp
  tools/fiber_query_refusals_test.cpp
  tools/fiber_query_test.cpp
  tools/fiber_scene_test.cpp
  tools/memory_test.cpp
  tools/motions_test.cpp
  tools/names_test.cpp
  tools/outputs_test.cpp
  tools/segments_test.cpp
  tools/self_contact_test.cpp
  tools/simulate_forces_test.cpp
  tools/simulate_test.cpp
  tools/simulate_trajectory_test.cpp
  tools/sweep_names_test.cpp
  tools/sweep_test.cpp
  tools/tiny_fibers_test.cpp
  tools/topology_test.cpp
  COLD
  LIBRARIES ${engine_libraries} fiber_proximity_scenes fiber_proximity_accuracy validation_geometry fiber_proximity_compare fiber_proximity_sim nlohmann_json::nlohmann_json
)
add_dependencies(tools_test fiber_query fiber_scene fiber_simulate)
target_compile_definitions(tools_test PRIVATE
  FIBER_QUERY="$<TARGET_FILE:fiber_query>"
  FIBER_SCENE="$<TARGET_FILE:fiber_scene>"
  FIBER_SIMULATE="$<TARGET_FILE:fiber_simulate>"
)

if(FIBER_PROXIMITY_BUILD_BENCHMARKS)
  add_subdirectory(benchmark)
endif()
