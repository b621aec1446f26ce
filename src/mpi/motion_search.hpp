#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/owned_fibers.hpp"
#include "src/mpi/send_lists.hpp"

namespace fiber {

/// [m] How near segments come that may be reported.
inline double reach_of(const MotionOptions& options) {
  return (1.0 + 0x1p-50) * (options.margin + options.tolerance);
}

/// Looks for the pairs that a rank reports that come into contact during a motion.
class MotionSearch {
 public:
  MotionSearch(const Communicator& ranks, const EngineOptions& options)
      : ranks_(ranks), engine_(make_engine("run_tree", options)) {}

  /// Makes the motion of these fibres the one that is looked at; they must live until the next
  /// update. Collective.
  /// @throws std::invalid_argument on every rank if a segment moves too far on one
  void update(const OwnedFibers& fibers);

  /// All pairs of a segment of this rank's own that there are, whatever type and limits of contacts
  /// the options have. Collective.
  /// @param spans  what others need, found with reach_of(options)
  /// @param result contacts and what is touching in any order; limit_reached: the pair_limit was.
  ///               Bounds are not set
  /// @throws std::invalid_argument on every rank if one has more than an assembly may have
  void find(const MotionOptions& options, const PerRank<RunSpan>& spans,
            DistributedMotionResult& result);

 private:
  void append(const MotionOptions& options, const LocalFibers& fibers_b, MotionResult& found,
              DistributedMotionResult& result) const;
  void evaluate(const MotionOptions& options, const std::vector<MotionContact>& candidates,
                MotionResult& result) const;

  const Communicator& ranks_;
  std::unique_ptr<ProximityEngine> engine_;
  const OwnedFibers* fibers_ = nullptr;
  LocalFibers halo_;
  LocalFibers halo_after_;
  MotionResult found_;  // work memory
};

}  // namespace fiber
