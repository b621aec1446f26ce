# What tests and benchmarks both stand on: cases that are hard, and scenes and motions whose answer is known.

# Pairs and motions of segments that are hard, and the truth about motions.
add_library(validation_geometry STATIC
  validation/geometry/hard_motions.cpp
  validation/geometry/hard_pairs.cpp
  validation/geometry/known_motions.cpp
  validation/geometry/motion_oracle.cpp
  validation/geometry/motion_score.cpp
  validation/geometry/motion_separation.cpp
  validation/geometry/time_polynomial.cpp
)
target_link_libraries(validation_geometry
  PUBLIC fiber_proximity PRIVATE Boost::headers fiber_proximity_options)

# Rods whose statics, motion and friction theory knows.
add_library(validation_sim STATIC
  validation/sim/elastica.cpp
  validation/sim/friction_scenes.cpp
  validation/sim/harness_scene.cpp
  validation/sim/impacts.cpp
  validation/sim/instability.cpp
  validation/sim/joints.cpp
  validation/sim/loads.cpp
  validation/sim/motion.cpp
  validation/sim/rolling.cpp
  validation/sim/statics.cpp
  validation/sim/strips.cpp
)
target_link_libraries(validation_sim
  PUBLIC fiber_proximity_sim PRIVATE Boost::headers fiber_proximity_options)
fiber_proximity_parse_once(validation_sim)
