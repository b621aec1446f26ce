# All tests below, and a file with their programs, for scripts/campaign.sh.
add_custom_target(unit_tests)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/unit_tests.txt
  CONTENT "$<JOIN:$<TARGET_GENEX_EVAL:unit_tests,$<TARGET_PROPERTY:unit_tests,PROGRAMS>>,\n>\n")

# fiber_proximity_compile_test(TARGET SPEED): SPEED is `fast`, or `cold` for one that computes little itself.
function(fiber_proximity_compile_test target speed)
  if(speed STREQUAL cold)
    fiber_proximity_compile_cold(${target})
  else()
    fiber_proximity_compile_fast(${target})
  endif()
endfunction()

# fiber_proximity_test_headers(NAME SPEED LIBRARY HEADER...)
# Precompiles gtest and these headers, of this library, once for all tests that reuse them from NAME: with the
# definitions that come with gtest, and the optimisation of these tests, or it is refused.
function(fiber_proximity_test_headers name speed library)
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp "")
    add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
    target_link_libraries(${name} PRIVATE ${library} fiber_proximity_options
      $<TARGET_NAME_IF_EXISTS:GTest::gtest>)
    target_precompile_headers(${name} PRIVATE ${ARGN} <gtest/gtest.h>)
    fiber_proximity_compile_test(${name} ${speed})
  endif()
endfunction()

fiber_proximity_test_headers(test_headers fast Eigen3::Eigen ${core_headers})
fiber_proximity_test_headers(cold_test_headers cold Eigen3::Eigen ${core_headers})

# The one source that knows where the package is: what else the compiler reads is the same in every checkout,
# so that ccache knows it again.
add_library(test_support STATIC ${PROJECT_SOURCE_DIR}/test/support/source_folder.cpp)
target_compile_definitions(test_support PRIVATE FIBER_PROXIMITY_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_link_libraries(test_support PRIVATE fiber_proximity_options)

# fiber_proximity_compile_tests_together(NAME...)
# All of a folder at once: what gtest, Eigen and ROS make of a source takes most of its time, and is the same in the
# next (node_test's seven units of five sources took 96 s, one of all takes 36; g++ 12, Intel Xeon, 2026-11-28).
function(fiber_proximity_compile_tests_together)
  foreach(name IN LISTS ARGN)
    fiber_proximity_compile_together(${name})
  endforeach()
endfunction()

# Those that tests of all engines link.
set(engine_libraries fiber_proximity_paper fiber_proximity_cuda)

# fiber_proximity_gtest(NAME SOURCE... [THREADED] [COLD] [HEADERS NAME] [LIBRARIES LIB...])
# A unit test that needs no ROS master: a catkin gtest in the package, a plain one without ROS, with
# the label `threaded` if it is THREADED: if several threads at once are what it is about. A test is COLD if it
# computes little itself: it is not optimised. It reuses the precompiled headers NAME, if not those of its kind.
function(fiber_proximity_gtest name)
  cmake_parse_arguments(ARG "THREADED;COLD" "HEADERS" "LIBRARIES" ${ARGN})
  if(FIBER_PROXIMITY_BUILD_ROS)
    catkin_add_gtest(${name} ${ARG_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} gtest_main)
  else()
    add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} GTest::gtest_main)
    add_test(NAME ${name} COMMAND ${name})
    if(ARG_THREADED)
      set_tests_properties(${name} PROPERTIES LABELS threaded)
    endif()
  endif()
  target_link_libraries(${name} fiber_proximity fiber_proximity_options test_support ${ARG_LIBRARIES})
  add_dependencies(unit_tests ${name})
  set_property(TARGET unit_tests APPEND PROPERTY PROGRAMS $<TARGET_FILE:${name}>)
  set(speed fast)
  set(headers test_headers)
  if(ARG_COLD)
    set(speed cold)
    set(headers cold_test_headers)
  endif()
  if(ARG_HEADERS)
    set(headers ${ARG_HEADERS})
  endif()
  fiber_proximity_compile_test(${name} ${speed})
  fiber_proximity_compile_tests_together(${name})
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    target_precompile_headers(${name} REUSE_FROM ${headers})
  endif()
endfunction()

# fiber_proximity_graph_tests(PROGRAM...)
# For programs that ask a running node: their headers are precompiled once for all.
function(fiber_proximity_graph_tests)
  fiber_proximity_compile_cold(${ARGN})
  fiber_proximity_compile_tests_together(${ARGN})
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    foreach(program IN LISTS ARGN)
      target_precompile_headers(${program} REUSE_FROM graph_test_headers)
    endforeach()
  endif()
endfunction()

# fiber_proximity_begin_first(COST NAME...)
# These of the tests of this folder begin before all others of lower COST, seconds about: a long one that comes last
# leaves the other cores idle. ctest goes by what it has measured, once it has.
function(fiber_proximity_begin_first cost)
  foreach(name IN LISTS ARGN)
    foreach(test ${name} _ctest_${PROJECT_NAME}_gtest_${name} _ctest_${PROJECT_NAME}_rostest_test_ros_${name}.test)
      if(TEST ${test})
        set_tests_properties(${test} PROPERTIES COST ${cost})
      endif()
    endforeach()
  endforeach()
endfunction()
