#pragma once

#include <tbb/task_arena.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/for_engines/loop_test.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/query/contact_evaluator.hpp"
#include "src/query/idle_memory.hpp"

namespace fiber {

class Device;
class DeviceTree;
struct HostFibers;
struct HostTopology;
struct PairRule;

/// `cuda_tree`: a GPU sorts, fits a tree and finds the pairs that are near, in single precision
/// that errs on the safe side; the processor decides about these, in the code of all engines: the
/// contacts are the same, bit for bit.
class FIBER_PROXIMITY_EXPORT CudaTreeEngine final : public ProximityEngine {
 public:
  CudaTreeEngine(std::unique_ptr<Device> device, const EngineOptions& options);
  ~CudaTreeEngine() override;

  EngineFacts facts() const override;

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override;
  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override;
  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override;
  void on_threads(const std::function<void()>& work) const override { arena_.execute(work); }

 private:
  struct Memory {
    std::vector<std::uint64_t> keys;
    ContactEvaluator evaluator;
  };
  /// Whose pairs are asked about: those of the fibres, if no shape is given.
  struct Subject;

  template <class Call>
  void with_device(const Call& call) const;
  void query(const Subject& subject, const QueryOptions& options, QueryResult& result) const;
  bool find_all(const Subject& subject, const NarrowPhase& test, const QueryOptions& options,
                const QueryLimits& limits, Memory& memory, QueryResult& result) const;
  void collect(const Subject& subject, const QueryOptions& options, Memory& memory,
               QueryResult& result) const;
  std::uint64_t offer(const Subject& subject, const PairRule& rule, PairCollector& collector,
                      std::vector<std::uint64_t>& keys) const;
  std::uint64_t find(const Subject& subject, std::uint32_t first_leaf, std::uint32_t leaf_count,
                     const PairRule& rule, std::uint64_t most,
                     std::vector<std::uint64_t>& keys) const;

  mutable tbb::task_arena arena_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<DeviceTree> tree_;
  std::vector<double> radii_;
  LoopTest loops_;
  mutable IdleMemory<Memory> memory_;
  mutable std::mutex mutex_;  // of the device: one query at a time has it
};

}  // namespace fiber
