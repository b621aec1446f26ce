#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/hierarchy/run_tree.hpp"

namespace fiber {

/// Options that decide the candidates of a query: they serve all queries of an equal key.
class CandidateKey {
 public:
  CandidateKey() = default;
  explicit CandidateKey(const PairOptions& options);

  bool operator==(const CandidateKey& other) const;

  double margin() const { return margin_; }  ///< [m]

 private:
  double margin_ = 0.0;  // [m]
  Pairing pairing_ = Pairing::ALL;
  std::optional<std::uint32_t> neighbour_skip_;
  std::optional<double> neighbour_skip_length_;  // [m]
};

/// Candidates of a query, kept for those after it; several threads may ask at the same time.
class CandidateCache {
 public:
  using Keys = std::shared_ptr<std::vector<std::uint64_t>>;

  enum class State {
    NONE,   ///< nobody is to have them any more; their memory is kept
    STALE,  ///< those of some segments are to be replaced
    CURRENT
  };

  /// State of the candidates that are kept.
  State state() const;

  /// [m] Of the queries that they serve, or served last.
  double margin() const;

  /// Makes them worse: CURRENT ones STALE or NONE, STALE ones NONE.
  void become(State worse);

  /// Those in this state of a query of the same key; null if there are none.
  Keys find(const QueryOptions& options, State state) const;

  /// Where to put new ones: memory that nobody else uses.
  Keys make();

  /// Keeps them, as CURRENT ones, for such queries.
  void keep(const QueryOptions& options, const Keys& keys);

  std::size_t memory_bytes() const;

 private:
  mutable std::mutex mutex_;
  State state_ = State::NONE;
  CandidateKey key_;
  Keys keys_;
  Keys spare_;  // the ones before, for their memory
};

/// The segments of fibres that have moved so far that the candidates kept of them no longer serve,
/// with a run tree of their own to look for others. Keeps its memory.
class DirtySegments {
 public:
  void clear();

  /// Adds the segments of this fibre unless they are there.
  void add(const FiberAssembly& fibers, std::uint32_t fiber);

  /// Fits the tree to the segments there are; to be called when all are added.
  void fit(const FiberAssembly& fibers, const Eigen::Vector3d& origin);

  std::size_t size() const { return first_points_.size(); }

  /// Whether a segment, by its first point, is dirty.
  bool contains(std::uint32_t first_point) const { return is_dirty_[first_point] != 0; }

  const RunTreeView& tree() const { return tree_.view(); }
  std::size_t memory_bytes() const;

 private:
  std::vector<std::uint32_t> first_points_;
  std::vector<std::uint8_t> is_dirty_;  // by first point
  RunTree tree_;
};

}  // namespace fiber
