# Pairs and motions that are hard, and answers about moving capsules beside the truth, for tests and benchmarks.

add_library(hard_cases STATIC test/support/hard_motions.cpp test/support/hard_pairs.cpp)
target_link_libraries(hard_cases PUBLIC fiber_proximity PRIVATE fiber_proximity_options)
find_package(Threads REQUIRED)
add_library(fiber_bench_motions STATIC
  benchmark/continuous/decision_score.cpp
  benchmark/continuous/known_motions.cpp
  benchmark/continuous/motion_accuracy.cpp
  benchmark/continuous/motion_oracle.cpp
  benchmark/continuous/motion_score.cpp
  benchmark/continuous/motion_separation.cpp
  benchmark/continuous/time_polynomial.cpp
)
target_link_libraries(fiber_bench_motions
  PUBLIC hard_cases PRIVATE Boost::headers Threads::Threads fiber_proximity_options)
