# What an installed package holds: each library is a component of find_package(fiber_proximity), with a file of
# exported targets of its own, so that one may be there without another.

if(FIBER_PROXIMITY_BUILD_ROS)
  set(library_folder ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(program_folder ${CATKIN_PACKAGE_BIN_DESTINATION})
  set(include_folder ${CATKIN_GLOBAL_INCLUDE_DESTINATION})
  set(package_folder ${CATKIN_PACKAGE_SHARE_DESTINATION}/cmake)
else()
  include(GNUInstallDirs)
  set(library_folder ${CMAKE_INSTALL_LIBDIR})
  set(program_folder ${CMAKE_INSTALL_BINDIR})
  set(include_folder ${CMAKE_INSTALL_INCLUDEDIR})
  set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fiber_proximity)
endif()

# fiber_proximity_component(COMPONENT LIBRARY [OBJECTS...])
# Installs and exports the library as fiber_proximity::COMPONENT. Objects are libraries it is made of.
function(fiber_proximity_component component library)
  # Programs load it by this version: before 1.0 a minor version may break them. Without a longer one there is only one
  # link, for those who build, which a wheel can do without.
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${component} INSTALL_RPATH "$ORIGIN"
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(${library} INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${include_folder}>)
  target_compile_features(${library} INTERFACE cxx_std_17)
  install(TARGETS ${library} EXPORT fiber_proximity-${component}
    ARCHIVE DESTINATION ${library_folder}
    LIBRARY DESTINATION ${library_folder}
    RUNTIME DESTINATION ${program_folder})
  install(EXPORT fiber_proximity-${component} NAMESPACE fiber_proximity::
    DESTINATION ${package_folder})
  # Beside the build, too, for whoever builds with it in one catkin workspace.
  if(FIBER_PROXIMITY_BUILD_ROS)
    export(EXPORT fiber_proximity-${component} NAMESPACE fiber_proximity::
      FILE ${CATKIN_DEVEL_PREFIX}/share/${PROJECT_NAME}/cmake/fiber_proximity-${component}.cmake)
  endif()
endfunction()

# Headers of an optional library come with it.
install(DIRECTORY include/fiber_proximity DESTINATION ${include_folder} FILES_MATCHING PATTERN "*.hpp"
  PATTERN include/fiber_proximity/mpi EXCLUDE)

# With ROS, catkin makes the package's configuration, and the components are one of its extras.
if(NOT FIBER_PROXIMITY_BUILD_ROS)
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/fiber_proximityConfigVersion.cmake
    VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
  install(FILES cmake/fiber_proximity-components.cmake.in DESTINATION ${package_folder}
    RENAME fiber_proximityConfig.cmake)
  install(FILES ${PROJECT_BINARY_DIR}/fiber_proximityConfigVersion.cmake
    DESTINATION ${package_folder})
endif()
