# Rods that move by the effects a scene calls for; no ROS.

add_library(fiber_proximity_sim SHARED
  src/sim/band_solver.cpp
  src/sim/contact_limits.cpp
  src/sim/contact_stiffness.cpp
  src/sim/contacts.cpp
  src/sim/coupled_step.cpp
  src/sim/edge_share.cpp
  src/sim/effects/attachment.cpp
  src/sim/effects/bend.cpp
  src/sim/effects/bend_lanes.cpp
  src/sim/effects/clamped_end.cpp
  src/sim/effects/damping.cpp
  src/sim/effects/damping_lanes.cpp
  src/sim/effects/drag.cpp
  src/sim/effects/drag_lanes.cpp
  src/sim/effects/environment_contact.cpp
  src/sim/effects/fiber_contact.cpp
  src/sim/effects/fiber_contact_limits.cpp
  src/sim/effects/friction.cpp
  src/sim/effects/gravity.cpp
  src/sim/effects/gravity_lanes.cpp
  src/sim/effects/inextensible.cpp
  src/sim/effects/inextensible_lanes.cpp
  src/sim/effects/natural_bend.cpp
  src/sim/effects/plasticity.cpp
  src/sim/effects/stretch.cpp
  src/sim/effects/stretch_lanes.cpp
  src/sim/effects/twist.cpp
  src/sim/effects/twist_lanes.cpp
  src/sim/energy_guard.cpp
  src/sim/islands.cpp
  src/sim/lane_sums.cpp
  src/sim/material.cpp
  src/sim/material_presets.cpp
  src/sim/natural_curvature.cpp
  src/sim/overlaps.cpp
  src/sim/reach.cpp
  src/sim/resolution.cpp
  src/sim/rod_batch.cpp
  src/sim/rod_batch_beginning.cpp
  src/sim/rod_batch_energy.cpp
  src/sim/rod_group.cpp
  src/sim/rod_group_contacts.cpp
  src/sim/rod_group_energy.cpp
  src/sim/rod_group_gains.cpp
  src/sim/rod_lanes.cpp
  src/sim/rod_system.cpp
  src/sim/rods.cpp
  src/sim/separate_overlaps.cpp
  src/sim/stepper.cpp
)
target_link_libraries(fiber_proximity_sim
  PUBLIC fiber_proximity_environment PRIVATE TBB::tbb hwy::hwy fiber_proximity_options)
target_include_directories(fiber_proximity_sim PRIVATE ${PROJECT_SOURCE_DIR})
fiber_proximity_parse_once(fiber_proximity_sim ${core_headers})
