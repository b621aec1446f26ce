#include "src/mpi/step_costs.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/rank_fibers.hpp"

namespace fiber {
namespace {

constexpr int steps_measured = 8;
constexpr double step_shift = 1e-6;  // [m] by which all points move

FiberAssembly shifted(const FiberAssembly& fibers) {
  std::vector<Eigen::Vector3d> points = fibers.points();
  for (Eigen::Vector3d& point : points) {
    point.x() += step_shift;
  }
  FiberAssembly moved = fibers;
  moved.exchange_points(points);
  return moved;
}

/// Of the fastest step [s], from when all ranks begin to when the last one ends.
double time_of_step(const Communicator& ranks, DistributedEngine& engine, DistributedFibers fibers,
                    const QueryOptions& query) {
  DistributedResult result;
  engine.update(fibers.parts, fibers.names);
  engine.query(query, result);
  fibers = engine.adopt();
  double fastest = std::numeric_limits<double>::infinity();
  for (int step = 0; step < steps_measured; ++step) {
    fibers.parts = shifted(fibers.parts);
    MPI_Barrier(ranks.handle());
    const auto begin = std::chrono::steady_clock::now();
    engine.update(fibers.parts, fibers.names);
    engine.query(query, result);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    fastest = std::min(fastest, ranks.largest(taken.count()));
  }
  return fastest;
}

double most_on_a_rank(const Communicator& ranks, std::uint64_t count) {
  return std::max(1.0, ranks.largest(static_cast<double>(count)));
}

/// What the split gives to this rank, as if there were nothing else.
DistributedFibers split(const Communicator& ranks, const DistributedFibers& fibers) {
  RankFibers all;
  all.update(ranks, fibers.parts, fibers.names);
  DistributedFibers own{all.own().fibers(), {}};
  for (std::uint64_t fiber = 0; fiber < own.parts.fiber_count(); ++fiber) {
    own.names.push_back({fiber, 0});
  }
  return own;
}

}  // namespace

StepCosts measure_steps(const Communicator& ranks, const DistributedFibers& fibers,
                        const EngineOptions& engine_options, const QueryOptions& query) {
  StepCosts costs;
  {
    const DistributedFibers own = split(ranks, fibers);
    DistributedEngine engine(MPI_COMM_SELF, engine_options);
    costs.alone =
        time_of_step(ranks, engine, own, query) / most_on_a_rank(ranks, own.parts.segment_count());
  }
  DistributedEngine engine(ranks.handle(), engine_options);
  const double time = time_of_step(ranks, engine, fibers, query);
  const DistributedFacts facts = engine.facts();
  costs.together = time / most_on_a_rank(ranks, facts.own_segments + facts.halo_segments);
  return costs;
}

}  // namespace fiber
