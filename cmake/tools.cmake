# Command line tools; installed where rosrun finds them, or in bin without ROS.

add_library(fiber_proximity_command_line OBJECT src/tools/command_line.cpp)
target_link_libraries(fiber_proximity_command_line PUBLIC
  fiber_proximity CLI11::CLI11 fiber_proximity_options)
target_link_libraries(fiber_proximity_command_line PUBLIC nlohmann_json::nlohmann_json)
fiber_proximity_compile_fast(fiber_proximity_command_line)
fiber_proximity_precompile(fiber_proximity_command_line ${tool_headers})

# fiber_proximity_compile_tool(TARGET)
# Tools hand on what libraries compute. CLI11 and json, most of what the compiler reads, are parsed once for all.
function(fiber_proximity_compile_tool target)
  fiber_proximity_compile_fast(${target})
  fiber_proximity_compile_together(${target})
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} REUSE_FROM fiber_proximity_command_line)
  endif()
endfunction()

# fiber_proximity_tool(NAME SOURCE...)
function(fiber_proximity_tool name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} fiber_proximity_command_line)
  file(RELATIVE_PATH libraries /${program_folder} /${library_folder})
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
  install(TARGETS ${name} RUNTIME DESTINATION ${program_folder})
endfunction()

# What fiber_query and fiber_query_mpi have in common.
add_library(fiber_proximity_query_tools OBJECT
  src/tools/candidate_checker.cpp src/tools/fiber_match.cpp src/tools/query_options.cpp)
target_link_libraries(fiber_proximity_query_tools PUBLIC fiber_proximity_command_line fiber_proximity_environment)
fiber_proximity_compile_tool(fiber_proximity_query_tools)

# What fiber_query and the node measure of settings, and fiber_bench of answers.
add_library(fiber_proximity_accuracy STATIC
  src/accuracy/accuracy_picture.cpp src/accuracy/accuracy_report.cpp src/accuracy/doubt_sources.cpp
  src/accuracy/answer_errors.cpp src/accuracy/answer_setting.cpp
  src/accuracy/frame_order.cpp src/accuracy/frame_survey.cpp src/accuracy/noise.cpp
  src/accuracy/recommendation.cpp src/accuracy/resampling.cpp
  src/accuracy/setting_choices.cpp src/accuracy/setting_measurement.cpp src/accuracy/setting_run.cpp
  src/accuracy/svg_drawing.cpp)
target_link_libraries(fiber_proximity_accuracy PUBLIC
  fiber_proximity nlohmann_json::nlohmann_json fiber_proximity_options)
set_target_properties(fiber_proximity_accuracy PROPERTIES POSITION_INDEPENDENT_CODE ON)
fiber_proximity_parse_once(fiber_proximity_accuracy)
