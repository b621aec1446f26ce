# Scenes whose answer theory knows, as tests and benchmarks of the simulation build them.

add_library(fiber_bench_sim STATIC
  benchmark/sim/elastica.cpp
  benchmark/sim/friction_scenes.cpp
  benchmark/sim/instability.cpp
  benchmark/sim/motion.cpp
  benchmark/sim/statics.cpp
)
target_link_libraries(fiber_bench_sim
  PUBLIC fiber_proximity_sim PRIVATE Boost::headers fiber_proximity_options)
fiber_proximity_parse_once(fiber_bench_sim)
