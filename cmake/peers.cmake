# Other libraries as engines of fiber_bench: those installed here, the others are left out. Only
# fiber_bench and a test link them. With CGAL in it, fiber_bench is under CGAL's GPL.

option(FIBER_PROXIMITY_PEERS "Build fiber_bench with the peers installed here" ON)

add_library(fiber_bench_peers STATIC
  benchmark/peers/peer.cpp
  benchmark/peers/peer_engine.cpp
  benchmark/peers/segment_boxes.cpp
)
target_include_directories(fiber_bench_peers PUBLIC benchmark)
target_link_libraries(fiber_bench_peers PUBLIC fiber_proximity PRIVATE fiber_proximity_options)

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

  # Headers only; CGAL's own configuration would ask for libraries these do not need.
  find_path(CGAL_INCLUDE_FOLDER CGAL/box_intersection_d.h)
  if(CGAL_INCLUDE_FOLDER)
    fiber_bench_peer(CGAL benchmark/peers/cgal.cpp INCLUDES ${CGAL_INCLUDE_FOLDER})
  endif()

  find_package(embree QUIET CONFIG)
  if(embree_FOUND)
    fiber_bench_peer(EMBREE benchmark/peers/embree.cpp LIBRARIES embree)
  endif()

  find_package(fcl 0.6 QUIET CONFIG)  # older ones have another interface
  if(fcl_FOUND)
    fiber_bench_peer(FCL benchmark/peers/fcl.cpp benchmark/peers/fcl_naive.cpp LIBRARIES fcl)
  endif()
endif()
