# Rods that move by the effects a scene calls for, and the YAML files of scenes; no ROS.

add_library(fiber_proximity_sim SHARED
  src/sim/contact/add_obstacle_contacts.cpp
  src/sim/contact/contact_neighbours.cpp
  src/sim/contact/contact_set.cpp
  src/sim/contact/contact_derivatives.cpp
  src/sim/contact/contact_set_forces.cpp
  src/sim/contact/contact_set_motion.cpp
  src/sim/contact/contact_set_work.cpp
  src/sim/contact/friction_anchors.cpp
  src/sim/contact/impact.cpp
  src/sim/contact/surface_lever.cpp
  src/sim/contact/contact_set_step.cpp
  src/sim/contact/edge_contact.cpp
  src/sim/contact/flat_parts.cpp
  src/sim/contact/moved_shape.cpp
  src/sim/contact/moved_shapes.cpp
  src/sim/contact/obstacle_contact.cpp
  src/sim/effects/attachment.cpp
  src/sim/effects/bend.cpp
  src/sim/effects/contacts.cpp
  src/sim/effects/damping.cpp
  src/sim/effects/drag.cpp
  src/sim/effects/gravity.cpp
  src/sim/effects/loads.cpp
  src/sim/effects/moving_obstacles.cpp
  src/sim/effects/moving_obstacle_contact.cpp
  src/sim/effects/natural_bend.cpp
  src/sim/effects/stiff_bend.cpp
  src/sim/effects/section_damping.cpp
  src/sim/effects/stretch.cpp
  src/sim/effects/twist.cpp
  src/sim/joint/joints.cpp
  src/sim/joint/make_welds.cpp
  src/sim/joint/weld.cpp
  src/sim/overlaps.cpp
  src/sim/separation.cpp
  src/sim/resolution.cpp
  src/sim/inertia.cpp
  src/sim/rods.cpp
  src/sim/sections.cpp
  src/sim/solver/joint_rows.cpp
  src/sim/solver/joint_solver.cpp
  src/sim/solver/newton.cpp
  src/sim/solver/pack_kernels.cpp
  src/sim/solver/newton_convergence.cpp
  src/sim/solver/newton_gains.cpp
  src/sim/solver/newton_correction.cpp
  src/sim/solver/newton_impacts.cpp
  src/sim/solver/newton_obstacles.cpp
  src/sim/solver/stage_adaption.cpp
  src/sim/solver/stage_forces.cpp
  src/sim/solver/stage_joints.cpp
  src/sim/solver/stage_obstacles.cpp
  src/sim/solver/stage_solver.cpp
  src/sim/stepper.cpp
)
target_link_libraries(fiber_proximity_sim
  PUBLIC fiber_proximity_environment PRIVATE TBB::tbb hwy::hwy fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_sim ${core_headers})
# Compiled apart: beside them the compiler would inline less of what scenes without them run through.
set_source_files_properties(src/sim/contact/moved_shape.cpp src/sim/contact/moved_shapes.cpp
  PROPERTIES UNITY_GROUP fiber_proximity_sim_moved)
fiber_proximity_component(sim fiber_proximity_sim)

# The files of scenes: compiled apart, as nothing in them takes time.
add_library(sim_scene OBJECT
  src/sim/scene/effect_entries.cpp
  src/sim/scene/effect_keys.cpp
  src/sim/scene/cut_curve.cpp
  src/sim/scene/effects.cpp
  src/sim/scene/fibers.cpp
  src/sim/scene/force_file.cpp
  src/sim/scene/holds.cpp
  src/sim/scene/joined_holds.cpp
  src/sim/scene/joints.cpp
  src/sim/scene/keys.cpp
  src/sim/scene/loads.cpp
  src/sim/scene/named_nodes.cpp
  src/sim/scene/natural_curvature.cpp
  src/sim/scene/obstacle_motion.cpp
  src/sim/scene/obstacles.cpp
  src/sim/scene/prediction.cpp
  src/sim/scene/prediction_observer.cpp
  src/sim/scene/prediction_summary.cpp
  src/sim/scene/reach.cpp
  src/sim/scene/real_time.cpp
  src/sim/scene/report.cpp
  src/sim/scene/resolution.cpp
  src/sim/scene/rope_net.cpp
  src/sim/scene/scene.cpp
  src/sim/scene/sections.cpp
  src/sim/scene/shapes.cpp
  src/sim/scene/times.cpp
)
set_target_properties(sim_scene PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(sim_scene PRIVATE Eigen3::Eigen yaml-cpp fiber_proximity_options)
fiber_proximity_parse_once(sim_scene ${yaml_headers})
fiber_proximity_compile_fast(sim_scene)
target_sources(fiber_proximity_sim PRIVATE $<TARGET_OBJECTS:sim_scene>)
