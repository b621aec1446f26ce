# Rods that move by the effects a scene calls for; no ROS.

add_library(fiber_proximity_sim SHARED
  src/sim/contact/contact_set.cpp
  src/sim/contact/contact_set_bound.cpp
  src/sim/contact/contact_set_forces.cpp
  src/sim/contact/edge_contact.cpp
  src/sim/contact/obstacle_contact.cpp
  src/sim/contact/obstacle_piece.cpp
  src/sim/contact/stiffness.cpp
  src/sim/effects/attachment.cpp
  src/sim/effects/bend.cpp
  src/sim/effects/clamped_end.cpp
  src/sim/effects/damping.cpp
  src/sim/effects/drag.cpp
  src/sim/effects/environment_contact.cpp
  src/sim/effects/fiber_contact.cpp
  src/sim/effects/friction.cpp
  src/sim/effects/gravity.cpp
  src/sim/effects/inextensible.cpp
  src/sim/effects/natural_bend.cpp
  src/sim/effects/plasticity.cpp
  src/sim/effects/stretch.cpp
  src/sim/effects/twist.cpp
  src/sim/material.cpp
  src/sim/material_presets.cpp
  src/sim/natural_curvature.cpp
  src/sim/overlaps.cpp
  src/sim/reach.cpp
  src/sim/resolution.cpp
  src/sim/rod_pack.cpp
  src/sim/rods.cpp
  src/sim/separate_overlaps.cpp
  src/sim/solver/band_solver.cpp
  src/sim/solver/coupling.cpp
  src/sim/solver/islands.cpp
  src/sim/solver/line_search.cpp
  src/sim/solver/newton.cpp
  src/sim/solver/pack_step.cpp
  src/sim/solver/pack_sums.cpp
  src/sim/solver/stage_adaption.cpp
  src/sim/solver/stage_solver.cpp
  src/sim/solver/step_bound.cpp
  src/sim/stepper.cpp
)
target_link_libraries(fiber_proximity_sim
  PUBLIC fiber_proximity_environment PRIVATE TBB::tbb hwy::hwy fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_sim ${core_headers})
