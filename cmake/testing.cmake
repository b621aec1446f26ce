# Those of the tests below that ThreadSanitizer is to see.
add_custom_target(threaded_tests)

# All tests below, and a file with their programs, for scripts/campaign.sh.
add_custom_target(unit_tests)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/unit_tests.txt
  CONTENT "$<JOIN:$<TARGET_GENEX_EVAL:unit_tests,$<TARGET_PROPERTY:unit_tests,PROGRAMS>>,\n>\n")

# fiber_proximity_test_headers(NAME LIBRARY HEADER...)
# Precompiles gtest and these headers, of this library, once for all tests that reuse them from NAME: with the
# definitions that come with gtest, or it is refused.
function(fiber_proximity_test_headers name library)
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp "")
    add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
    target_link_libraries(${name} PRIVATE ${library} fiber_proximity_options
      $<TARGET_NAME_IF_EXISTS:GTest::gtest>)
    target_precompile_headers(${name} PRIVATE ${ARGN} <gtest/gtest.h>)
    fiber_proximity_compile_fast(${name})
  endif()
endfunction()

fiber_proximity_test_headers(test_headers Eigen3::Eigen ${core_headers})

# The one source that knows where the package is: what else the compiler reads is the same in every checkout,
# so that ccache knows it again.
add_library(test_support STATIC ${PROJECT_SOURCE_DIR}/test/support/source_folder.cpp)
target_compile_definitions(test_support PRIVATE FIBER_PROXIMITY_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_link_libraries(test_support PRIVATE fiber_proximity_options)

# fiber_proximity_compile_tests_together(NAME...)
# What gtest and Eigen make of a source takes most of its time, and is the same in the next.
function(fiber_proximity_compile_tests_together)
  foreach(name IN LISTS ARGN)
    fiber_proximity_compile_together(${name} 5)
  endforeach()
endfunction()

# fiber_proximity_gtest(NAME SOURCE... [THREADED] [LIBRARIES LIB...])
# A unit test that needs no ROS master: a catkin gtest in the package, a plain one without ROS, with
# the label `threaded` if it is THREADED: if several threads at once are what it is about.
function(fiber_proximity_gtest name)
  cmake_parse_arguments(ARG "THREADED" "" "LIBRARIES" ${ARGN})
  if(FIBER_PROXIMITY_BUILD_ROS)
    catkin_add_gtest(${name} ${ARG_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} gtest_main)
  else()
    add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} GTest::gtest_main)
    add_test(NAME ${name} COMMAND ${name})
    if(ARG_THREADED)
      set_tests_properties(${name} PROPERTIES LABELS threaded)
      add_dependencies(threaded_tests ${name})
    endif()
  endif()
  target_link_libraries(${name}
    fiber_proximity_paper fiber_proximity_scenes fiber_proximity_options test_support ${ARG_LIBRARIES})
  add_dependencies(unit_tests ${name})
  set_property(TARGET unit_tests APPEND PROPERTY PROGRAMS $<TARGET_FILE:${name}>)
  fiber_proximity_compile_fast(${name})
  fiber_proximity_compile_tests_together(${name})
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    target_precompile_headers(${name} REUSE_FROM test_headers)
  endif()
endfunction()

# fiber_proximity_graph_tests(PROGRAM...)
# For programs that ask a running node: their headers are precompiled once for all.
function(fiber_proximity_graph_tests)
  fiber_proximity_compile_fast(${ARGN})
  fiber_proximity_compile_tests_together(${ARGN})
  fiber_proximity_test_headers(graph_test_headers fiber_proximity_ros ${ros_headers})
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    foreach(program IN LISTS ARGN)
      target_precompile_headers(${program} REUSE_FROM graph_test_headers)
    endforeach()
  endif()
endfunction()
