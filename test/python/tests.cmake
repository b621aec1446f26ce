if(NOT TARGET fiber_proximity_python)
  return()
endif()

get_filename_component(python_path ${python_build_folder} DIRECTORY)
# ctest replaces the variable, so what catkin's setup.bash has put there stays in it.
#catkin_lint: ignore_once env_var
set(python_environment PYTHONPATH=${python_path}:$ENV{PYTHONPATH})
if(FIBER_PROXIMITY_SANITIZE)
  # Python itself knows no sanitizer: its runtime must be there first, and what throws exceptions with it.
  foreach(library asan stdc++)
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${library}.so
      OUTPUT_VARIABLE file OUTPUT_STRIP_TRAILING_WHITESPACE)
    list(APPEND preloaded ${file})
  endforeach()
  list(JOIN preloaded ":" preloaded)
  list(APPEND python_environment LD_PRELOAD=${preloaded} ASAN_OPTIONS=detect_leaks=0 PYTHONMALLOC=malloc)
endif()

# fiber_proximity_python_test(NAME [ARGUMENT...]): test/python/NAME.py with the module of this build.
function(fiber_proximity_python_test name)
  add_test(NAME python_${name}
    COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/test/python/${name}.py ${ARGN})
  set_tests_properties(python_${name} PROPERTIES ENVIRONMENT "${python_environment}")
endfunction()

fiber_proximity_python_test(bad_input)
fiber_proximity_python_test(device)
fiber_proximity_python_test(doctests)
fiber_proximity_python_test(fibers)
fiber_proximity_python_test(files)
fiber_proximity_python_test(message_shapes)
fiber_proximity_python_test(motions)
fiber_proximity_python_test(ownership)
fiber_proximity_python_test(package ${PROJECT_BINARY_DIR} ${python_path})
fiber_proximity_python_test(queries)
fiber_proximity_python_test(scenes)
fiber_proximity_python_test(stubs)
fiber_proximity_python_test(threads)
if(NOT FIBER_PROXIMITY_SANITIZE)
  fiber_proximity_python_test(memory)  # asks the system's malloc
  fiber_proximity_python_test(examples ${PROJECT_SOURCE_DIR}/examples/python)
  fiber_proximity_python_test(peers ${PROJECT_SOURCE_DIR}/benchmark/python/peers.py)
endif()
if(FIBER_PROXIMITY_BUILD_ROS)
  fiber_proximity_python_test(messages)
  fiber_proximity_python_test(accuracy_of_bag ${PROJECT_SOURCE_DIR}/scripts/accuracy_of_bag.py $<TARGET_FILE:fiber_query>)
endif()
