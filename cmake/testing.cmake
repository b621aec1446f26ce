# Those of the tests below that ThreadSanitizer is to see.
add_custom_target(threaded_tests)

# Precompiled once for all tests: gtest, and what our headers include.
if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp "")
  add_library(test_headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
  # With the definitions that come with gtest, or it is refused.
  target_link_libraries(test_headers PRIVATE Eigen3::Eigen fiber_proximity_options
    $<TARGET_NAME_IF_EXISTS:GTest::gtest>)
  target_precompile_headers(test_headers PRIVATE ${core_headers} <gtest/gtest.h>)
endif()

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
  # Some scenes are those of benchmarks, too.
  target_include_directories(${name} PRIVATE
    ${PROJECT_SOURCE_DIR}/test ${PROJECT_SOURCE_DIR}/benchmark)
  target_compile_definitions(${name} PRIVATE
    FIBER_PROXIMITY_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    FIBER_PROXIMITY_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(${name} fiber_proximity fiber_proximity_options ${ARG_LIBRARIES})
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    target_precompile_headers(${name} REUSE_FROM test_headers)
  endif()
endfunction()
