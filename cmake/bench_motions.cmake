# Answers about moving capsules and the truth, as tests and benchmarks compare them.

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
  PUBLIC fiber_proximity_paper PRIVATE Boost::headers Threads::Threads fiber_proximity_options)
