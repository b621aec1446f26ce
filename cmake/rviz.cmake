# The rviz display of fiber_proximity/FiberArray, where rviz is installed. Nothing else depends on it.

# What it draws, free of rviz: tested without.
add_library(fiber_proximity_mesh STATIC
  src/rviz/answer_history.cpp
  src/rviz/fiber_colors.cpp
  src/rviz/fiber_detail.cpp
  src/rviz/fiber_mesh.cpp
  src/rviz/marker_texts.cpp
)
set_target_properties(fiber_proximity_mesh PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(fiber_proximity_mesh
  PUBLIC fiber_proximity_ros PRIVATE fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_mesh)

find_package(rviz QUIET)
find_package(Qt5 QUIET COMPONENTS Widgets)
if(NOT rviz_FOUND OR NOT Qt5_FOUND)
  message(STATUS "rviz or Qt 5 is not installed: its display of fibres is not built")
  return()
endif()

add_library(fiber_proximity_rviz SHARED
  src/rviz/accuracy_panel.cpp
  src/rviz/answer_plot.cpp
  src/rviz/display_properties.cpp
  src/rviz/fiber_array_display.cpp
  src/rviz/fiber_materials.cpp
  src/rviz/fiber_renderable.cpp
  src/rviz/legend_display.cpp
  src/rviz/parameter_form.cpp
  src/rviz/settings_chart.cpp
  src/rviz/text_overlay.cpp
  src/rviz/view_fit.cpp
)
#catkin_lint: ignore_once external_directory
#catkin_lint: ignore_once external_interface_path
target_include_directories(fiber_proximity_rviz SYSTEM PUBLIC ${rviz_INCLUDE_DIRS})
target_link_libraries(fiber_proximity_rviz
  PUBLIC fiber_proximity_mesh ${rviz_LIBRARIES} Qt5::Widgets PRIVATE fiber_proximity_options)
# Or TBB's headers do not survive after Qt's: both have something called emit.
target_compile_definitions(fiber_proximity_rviz PRIVATE QT_NO_KEYWORDS)
fiber_proximity_parse_once(fiber_proximity_rviz)
fiber_proximity_compile_fast(fiber_proximity_rviz)

install(TARGETS fiber_proximity_rviz
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION}
)
install(FILES rviz_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})

# Uses the window that the display is tested in.
add_executable(display_rate EXCLUDE_FROM_ALL benchmark/display_rate.cpp)
target_link_libraries(display_rate fiber_proximity_rviz fiber_proximity_options)
