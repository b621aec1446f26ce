# The Python module: src/python over the libraries, in one package with the messages that catkin generates.

include(cmake/python.cmake)
option(FIBER_PROXIMITY_BUILD_PYTHON "Build the Python module, where pybind11 is installed" ON)

# Where the package is, beside the build and installed. Debian's Python looks there under /usr, catkin's
# setup.bash puts it on PYTHONPATH.
set(python_folder lib/python3/dist-packages/fiber_proximity)
set(python_build_folder ${PROJECT_BINARY_DIR}/${python_folder})
if(FIBER_PROXIMITY_BUILD_ROS)
  set(python_folder ${CATKIN_PACKAGE_PYTHON_DESTINATION})
  set(python_build_folder ${CATKIN_DEVEL_PREFIX}/${python_folder})
endif()

# In place of the empty __init__.py that is generated with the messages: also where the module is not built, as a
# wheel that is installed elsewhere needs it to find them.
set(python_sources __init__.py __init__.pyi marker_messages.py messages.py point_messages.py py.typed robot.py)
foreach(source IN LISTS python_sources)
  configure_file(src/python/fiber_proximity/${source} ${python_build_folder}/${source} COPYONLY)
  install(FILES src/python/fiber_proximity/${source} DESTINATION ${python_folder})
  install(FILES src/python/fiber_proximity/${source} DESTINATION fiber_proximity
    COMPONENT wheel EXCLUDE_FROM_ALL)
endforeach()

if(NOT FIBER_PROXIMITY_BUILD_PYTHON)
  message(STATUS "Python module: left out, FIBER_PROXIMITY_BUILD_PYTHON is off")
  return()
endif()
# Its headers, too: the interpreter alone, which ROS finds, satisfies pybind11.
find_package(Python3 QUIET COMPONENTS Interpreter Development)
find_package(pybind11 2.4 QUIET)
if(NOT Python3_Development_FOUND OR NOT pybind11_FOUND)
  message(STATUS "Python module: left out, pybind11 (pybind11-dev) or Python's headers (python3-dev) are missing")
  return()
endif()
message(STATUS "Python module: for ${Python3_EXECUTABLE}, pybind11 ${pybind11_VERSION}")

add_library(fiber_proximity_python MODULE
  src/python/arrays.cpp
  src/python/candidates.cpp
  src/python/check.cpp
  src/python/contacts.cpp
  src/python/curves.cpp
  src/python/device_arrays.cpp
  src/python/device_contacts.cpp
  src/python/device_proximity.cpp
  src/python/engine.cpp
  src/python/environment.cpp
  src/python/environment_objects.cpp
  src/python/errors.cpp
  src/python/fiber_arguments.cpp
  src/python/fibers.cpp
  src/python/files.cpp
  src/python/forces.cpp
  src/python/module.cpp
  src/python/options.cpp
  src/python/prediction.cpp
  src/python/simulation.cpp
  src/python/simulation_bindings.cpp
  src/python/topology.cpp
)
target_link_libraries(fiber_proximity_python PRIVATE
  fiber_proximity_sim fiber_proximity_paper fiber_proximity_cuda pybind11::module fiber_proximity_options)
file(RELATIVE_PATH libraries /${python_folder} /${library_folder})
# pybind11's own types are hidden, and so are ours that hold them. In a wheel the libraries are beside the module.
set_target_properties(fiber_proximity_python PROPERTIES
  PREFIX "" OUTPUT_NAME _native SUFFIX ${PYTHON_MODULE_EXTENSION}
  CXX_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY ${python_build_folder}
  INSTALL_RPATH "$ORIGIN;$ORIGIN/${libraries}")
# Arrays that it is given may lie anywhere.
set_target_properties(fiber_proximity_python PROPERTIES SANITIZE_ALIGNMENT ON)
fiber_proximity_compile_together(fiber_proximity_python)
fiber_proximity_precompile(fiber_proximity_python ${core_headers} <pybind11/numpy.h> <pybind11/stl.h>)
fiber_proximity_compile_fast(fiber_proximity_python)
install(TARGETS fiber_proximity_python LIBRARY DESTINATION ${python_folder})
# All that a wheel holds: setup.py installs this component.
set(wheel_modules fiber_proximity_python)
if(TARGET fiber_proximity_cuda_device)
  list(APPEND wheel_modules fiber_proximity_cuda_device)
endif()
install(TARGETS ${wheel_modules} fiber_proximity fiber_proximity_paper fiber_proximity_cuda fiber_proximity_environment
  fiber_proximity_sim LIBRARY DESTINATION fiber_proximity COMPONENT wheel NAMELINK_SKIP EXCLUDE_FROM_ALL)
if(FIBER_PROXIMITY_BUILD_ROS)
  # By name with rosrun.
  catkin_install_python(PROGRAMS
    examples/python/clearance_over_time.py examples/python/fit_stiffness.py
    examples/python/plan_two_grippers.py examples/python/plot_clearances.py
    examples/python/predict_motion.py scripts/accuracy_of_bag.py
    DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  install(FILES examples/python/swinging_cable.csv DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endif()
if(FIBER_PROXIMITY_BUILD_BENCHMARKS)
  # What benchmark/python/calls.py measures beside.
  add_executable(fiber_python_calls EXCLUDE_FROM_ALL benchmark/python/calls.cpp)
  target_link_libraries(fiber_python_calls fiber_proximity_environment fiber_proximity_options)
endif()
