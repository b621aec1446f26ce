# Command line tools; installed where rosrun finds them, or in bin without ROS.

add_library(fiber_proximity_command_line OBJECT src/tools/command_line.cpp)
target_link_libraries(fiber_proximity_command_line PUBLIC
  fiber_proximity_paper CLI11::CLI11 fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_command_line ${tool_headers})
fiber_proximity_compile_fast(fiber_proximity_command_line)

# fiber_proximity_tool(NAME SOURCE...)
function(fiber_proximity_tool name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} fiber_proximity_command_line nlohmann_json::nlohmann_json)
  file(RELATIVE_PATH libraries /${program_folder} /${library_folder})
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
  install(TARGETS ${name} RUNTIME DESTINATION ${program_folder})
endfunction()
