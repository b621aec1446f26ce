# FCL run beside our engines.

add_library(fiber_proximity_compare SHARED
  src/compare/fcl_broad_phase.cpp
  src/compare/fcl_comparer.cpp
  src/compare/pair_oracle.cpp
)
target_link_libraries(fiber_proximity_compare
  PUBLIC fiber_proximity PRIVATE fcl fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_compare ${fcl_headers})
fiber_proximity_component(compare fiber_proximity_compare)
