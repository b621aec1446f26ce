// Measures in C++ the calls that benchmark/python/calls.py measures in Python.
//   fiber_python_calls contacts|closest|update|nearest|check FILE MARGIN REPEATS
// Prints the median time of a call [s]. Of `check`, the frames of the file are the candidates.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace {

/// Calls made between two looks at the clock, which takes a part of a microsecond itself.
constexpr int calls_per_look = 100;

double median_seconds(int repeats, int calls, const std::function<void()>& call) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const Clock::time_point begin = Clock::now();
    for (int j = 0; j < calls; ++j) {
      call();
    }
    times.push_back(std::chrono::duration<double>(Clock::now() - begin).count() / calls);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats / 2)];
}

double run(const std::string& what, const fiber::FiberFile& file, double margin, int repeats) {
  const fiber::FiberAssembly& fibers = file.frames.front().fibers;
  const int calls = fibers.segment_count() < 1000 && what != "check" ? calls_per_look : 1;
  const auto engine = fiber::make_engine("run_tree");
  fiber::QueryOptions options;
  options.margin = margin;
  fiber::QueryResult result;
  if (what != "check") {
    engine->update(fibers);
  }
  if (what == "contacts") {
    // A new result each time: Python's array is one.
    return median_seconds(repeats, calls, [&] {
      fiber::QueryResult fresh;
      engine->query(options, fresh);
    });
  }
  if (what == "closest") {
    options.type = fiber::QueryType::CLOSEST;
    return median_seconds(repeats, calls, [&] { engine->query(options, result); });
  }
  if (what == "update") {
    return median_seconds(repeats, calls, [&] { engine->update(fibers); });
  }
  if (what == "nearest") {
    return median_seconds(repeats, calls, [&] {
      fiber::nearest_segments(*engine, Eigen::Vector3d::Zero(), 1, result);
    });
  }
  std::vector<fiber::FiberAssembly> candidates;
  for (const fiber::FiberFrame& frame : file.frames) {
    candidates.push_back(frame.fibers);
  }
  options.type = fiber::QueryType::FIRST;
  std::vector<fiber::FiberCheck> checks;
  return median_seconds(repeats, calls, [&] {
    fiber::check_fibers(candidates, fiber::Surroundings(), options, checks);
  });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr
        << "usage: fiber_python_calls contacts|closest|update|nearest|check FILE MARGIN REPEATS\n";
    return 2;
  }
  std::cout << run(argv[1], fiber::read_fibers(argv[2]), std::atof(argv[3]), std::atoi(argv[4]))
            << "\n";
}
