# The same answers from any number of ranks, over loopback; included from test/, where paths begin.

if(TARGET fiber_proximity_mpi)
  add_executable(distributed_engine_test
    mpi/broken_files_test.cpp
    mpi/contact_files_test.cpp
    mpi/work_queue_test.cpp
    mpi/distributed_engine_test.cpp
    mpi/distributed_errors_test.cpp
    mpi/distributed_fiber_pairs_test.cpp
    mpi/distributed_files_test.cpp
    mpi/distributed_halo_test.cpp
    mpi/distributed_joints_test.cpp
    mpi/distributed_motion_test.cpp
    mpi/loop_questions_test.cpp
    mpi/partition_test.cpp
    mpi/mpi_main.cpp
  )
  if(FIBER_PROXIMITY_BUILD_ROS)
    target_link_libraries(distributed_engine_test gtest)
    add_dependencies(tests distributed_engine_test)
  else()
    target_link_libraries(distributed_engine_test GTest::gtest)
  endif()
  target_link_libraries(distributed_engine_test
    fiber_proximity_mpi ${PARALLEL_HDF5_LIBRARY} fiber_proximity_options)
  target_include_directories(distributed_engine_test SYSTEM PRIVATE ${PARALLEL_HDF5_INCLUDE_FOLDER})
  fiber_proximity_compile_fast(distributed_engine_test)
  fiber_proximity_compile_tests_together(distributed_engine_test)
  execute_process(COMMAND ${MPIEXEC_EXECUTABLE} --version OUTPUT_VARIABLE mpiexec_version ERROR_QUIET)
  # Ranks of one machine, more than it has cores, and also where all is done as root, as in containers.
  set(mpiexec_flags "")
  if(mpiexec_version MATCHES "Open MPI|OpenRTE")
    set(mpiexec_flags --allow-run-as-root --oversubscribe --bind-to none --mca mpi_yield_when_idle 1
      --mca btl self,vader,tcp --mca btl_tcp_if_include lo --mca oob_tcp_if_include lo)
  endif()
  set(start_ranks ${MPIEXEC_EXECUTABLE} ${mpiexec_flags} ${MPIEXEC_NUMPROC_FLAG})
  foreach(ranks 1 2 3 7)
    add_test(NAME distributed_engine_test_${ranks}
      COMMAND ${start_ranks} ${ranks} $<TARGET_FILE:distributed_engine_test>)
    # Ranks wait for each other at every step: beside other tests all wait for the one that waits for a core.
    if(ranks GREATER 1)
      set_tests_properties(distributed_engine_test_${ranks} PROPERTIES RUN_SERIAL TRUE)
    endif()
  endforeach()
  add_test(NAME fiber_query_mpi_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/fiber_query_mpi_test.sh $<TARGET_FILE_DIR:fiber_query_mpi>
      ${start_ranks})
  add_test(NAME fiber_query_mpi_check_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/fiber_query_mpi_check_test.sh $<TARGET_FILE_DIR:fiber_query_mpi>
      ${start_ranks})
  add_test(NAME joined_files_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/joined_files_test.sh $<TARGET_FILE_DIR:fiber_query_mpi> ${start_ranks})
  add_test(NAME outputs_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/outputs_test.sh $<TARGET_FILE_DIR:fiber_query_mpi> ${start_ranks})
  add_test(NAME fiber_scene_mpi_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/fiber_scene_mpi_test.sh $<TARGET_FILE_DIR:fiber_scene_mpi>
      ${start_ranks})
  if(TARGET fiber_forecast_mpi)
    add_test(NAME fiber_forecast_mpi_test
      COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/fiber_forecast_mpi_test.sh $<TARGET_FILE_DIR:fiber_forecast_mpi>
        ${start_ranks})
  endif()
  foreach(fault failing_zoltan held_rename no_threads)
    add_library(${fault} MODULE mpi/${fault}.cpp)
    set_target_properties(${fault} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test/faults)
    target_include_directories(${fault} SYSTEM PRIVATE ${ZOLTAN_INCLUDE_FOLDER})
    target_link_libraries(${fault} MPI::MPI_CXX fiber_proximity_options ${CMAKE_DL_LIBS})
  endforeach()
  add_test(NAME distributed_faults_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/distributed_faults_test.sh $<TARGET_FILE_DIR:fiber_query_mpi>
      $<TARGET_FILE_DIR:no_threads> ${start_ranks})
  add_test(NAME batch_file_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mpi/batch_file_test.sh ${PROJECT_SOURCE_DIR}/examples/contacts.sbatch
      $<TARGET_FILE_DIR:fiber_query_mpi> ${start_ranks})
  add_test(NAME distributed_page_test
    COMMAND /usr/bin/python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/mpi/distributed_page_test.py
      ${PROJECT_SOURCE_DIR}/docs/distributed.md $<TARGET_FILE_DIR:fiber_query_mpi> ${start_ranks})
  add_test(NAME vtkhdf_test
    COMMAND /usr/bin/python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/mpi/vtkhdf_test.py $<TARGET_FILE_DIR:fiber_query_mpi>
      ${start_ranks})
  set_tests_properties(vtkhdf_test PROPERTIES SKIP_RETURN_CODE 77)
endif()
