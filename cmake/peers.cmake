# Other libraries as engines and as kernels of fiber_bench: those installed here, the others are left
# out. Only fiber_bench and tests link them. With CGAL in it, fiber_bench is under CGAL's GPL.

option(FIBER_PROXIMITY_PEERS "Build fiber_bench with the peers installed here" ON)

find_package(Threads REQUIRED)
add_library(fiber_bench_peers STATIC
  benchmark/continuous/motion_accuracy.cpp
  benchmark/kernels/child_process.cpp
  benchmark/kernels/decision_score.cpp
  benchmark/kernels/discrete_motions.cpp
  benchmark/kernels/guarded_calls.cpp
  benchmark/kernels/kernel_lists.cpp
  benchmark/kernels/motion_times.cpp
  benchmark/kernels/own_motions.cpp
  benchmark/kernels/own_pairs.cpp
  benchmark/kernels/pair_score.cpp
  benchmark/kernels/pair_times.cpp
  benchmark/kernels/textbook_pairs.cpp
  benchmark/kernels/turn_times.cpp
  benchmark/peers/cable_peers.cpp
  benchmark/peers/peer.cpp
  benchmark/peers/peer_engine.cpp
)
target_link_libraries(fiber_bench_peers
  PUBLIC validation_geometry fiber_proximity PRIVATE Threads::Threads fiber_proximity_options)

# fiber_bench_peer(NAME SOURCE... [LIBRARIES LIB...] [INCLUDES FOLDER...])
function(fiber_bench_peer name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;INCLUDES" ${ARGN})
  target_sources(fiber_bench_peers PRIVATE ${ARG_UNPARSED_ARGUMENTS})
  target_compile_definitions(fiber_bench_peers PRIVATE FIBER_BENCH_HAS_${name})
  target_include_directories(fiber_bench_peers SYSTEM PRIVATE ${ARG_INCLUDES})
  target_link_libraries(fiber_bench_peers PRIVATE ${ARG_LIBRARIES})
endfunction()

if(FIBER_PROXIMITY_PEERS)
  find_path(BULLET_INCLUDE_FOLDER BulletCollision/BroadphaseCollision/btDbvt.h
    PATH_SUFFIXES bullet)
  find_library(BULLET_COLLISION_LIBRARY BulletCollision)
  find_library(BULLET_MATH_LIBRARY LinearMath)
  if(BULLET_INCLUDE_FOLDER AND BULLET_COLLISION_LIBRARY AND BULLET_MATH_LIBRARY)
    fiber_bench_peer(BULLET benchmark/peers/bullet.cpp
      LIBRARIES ${BULLET_COLLISION_LIBRARY} ${BULLET_MATH_LIBRARY}
      INCLUDES ${BULLET_INCLUDE_FOLDER})
  endif()

  find_library(BULLET_DYNAMICS_LIBRARY BulletDynamics)
  find_library(BULLET_SOFT_BODY_LIBRARY BulletSoftBody)
  if(BULLET_INCLUDE_FOLDER AND BULLET_COLLISION_LIBRARY AND BULLET_MATH_LIBRARY
      AND BULLET_DYNAMICS_LIBRARY AND BULLET_SOFT_BODY_LIBRARY)
    fiber_bench_peer(BULLET_ROPE benchmark/peers/bullet_rope.cpp
      LIBRARIES ${BULLET_SOFT_BODY_LIBRARY} ${BULLET_DYNAMICS_LIBRARY}
        ${BULLET_COLLISION_LIBRARY} ${BULLET_MATH_LIBRARY}
      INCLUDES ${BULLET_INCLUDE_FOLDER})
  endif()

  find_path(MUJOCO_INCLUDE_FOLDER mujoco/mujoco.h)
  find_library(MUJOCO_LIBRARY mujoco)
  if(MUJOCO_INCLUDE_FOLDER AND MUJOCO_LIBRARY)
    fiber_bench_peer(MUJOCO benchmark/peers/mujoco_chain.cpp
      LIBRARIES ${MUJOCO_LIBRARY} INCLUDES ${MUJOCO_INCLUDE_FOLDER})
  endif()

  # In double Bullet has the same symbols: a module with its own libraries, loaded when asked for, in
  # a way that sanitizers refuse.
  find_library(BULLET_COLLISION_DOUBLE_LIBRARY BulletCollision-float64)
  find_library(BULLET_MATH_DOUBLE_LIBRARY LinearMath-float64)
  if(BULLET_INCLUDE_FOLDER AND BULLET_COLLISION_DOUBLE_LIBRARY AND BULLET_MATH_DOUBLE_LIBRARY
      AND NOT FIBER_PROXIMITY_SANITIZE)
    add_library(fiber_bench_bullet_pairs MODULE
      benchmark/peers/bullet_motions.cpp benchmark/peers/bullet_pairs.cpp)
    target_compile_definitions(fiber_bench_bullet_pairs PRIVATE BT_USE_DOUBLE_PRECISION)
    target_include_directories(fiber_bench_bullet_pairs SYSTEM PRIVATE ${BULLET_INCLUDE_FOLDER})
    set_target_properties(fiber_bench_bullet_pairs PROPERTIES CXX_VISIBILITY_PRESET hidden)
    target_link_libraries(fiber_bench_bullet_pairs PRIVATE
      Eigen3::Eigen ${BULLET_COLLISION_DOUBLE_LIBRARY} ${BULLET_MATH_DOUBLE_LIBRARY}
      fiber_proximity_options)
    fiber_bench_peer(BULLET_PAIRS benchmark/peers/bullet_module.cpp
      LIBRARIES ${CMAKE_DL_LIBS})
    target_compile_definitions(fiber_bench_peers PRIVATE
      FIBER_BENCH_BULLET_PAIRS="$<TARGET_FILE:fiber_bench_bullet_pairs>")
    add_dependencies(fiber_bench_peers fiber_bench_bullet_pairs)
  endif()

  # Headers only; CGAL's own configuration would ask for libraries these do not need.
  find_path(CGAL_INCLUDE_FOLDER CGAL/box_intersection_d.h)
  if(CGAL_INCLUDE_FOLDER)
    fiber_bench_peer(CGAL benchmark/peers/cgal.cpp INCLUDES ${CGAL_INCLUDE_FOLDER})
    find_library(CGAL_GMP_LIBRARY gmp)
    find_library(CGAL_MPFR_LIBRARY mpfr)
    if(CGAL_GMP_LIBRARY AND CGAL_MPFR_LIBRARY)
      fiber_bench_peer(CGAL_PAIRS benchmark/peers/cgal_pairs.cpp
        LIBRARIES ${CGAL_MPFR_LIBRARY} ${CGAL_GMP_LIBRARY} INCLUDES ${CGAL_INCLUDE_FOLDER})
      # Its intervals set the direction of rounding.
      set_source_files_properties(benchmark/peers/cgal_pairs.cpp PROPERTIES
        COMPILE_OPTIONS -frounding-math)
    endif()
  endif()

  find_package(embree QUIET CONFIG)
  if(embree_FOUND)
    fiber_bench_peer(EMBREE benchmark/peers/embree.cpp LIBRARIES embree)
  endif()

  fiber_bench_peer(FCL benchmark/peers/fcl.cpp benchmark/peers/fcl_motions.cpp
    benchmark/peers/fcl_pairs.cpp
    LIBRARIES fiber_proximity_compare fcl)
endif()
