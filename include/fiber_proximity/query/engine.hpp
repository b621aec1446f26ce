#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

class LoopTest;
class NarrowPhase;
struct MotionCandidates;
struct QueryLimits;

/// An axis-aligned box of a hierarchy, for drawing [m].
struct NodeBox {
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
};

/// Options that change the cost of answers, and not the answers. Only run_tree heeds it.
struct EngineOptions {
  /// Most threads to use, 0 for as many as there are cores.
  std::uint32_t threads = 0;

  /// [m] finite, >= 0. Pairs up to this far beyond the margin are kept, too, and serve as long as
  /// no two segments that are near each other have moved by more than this beside each other; 0
  /// looks for them in every query. Without a value the engine chooses by what points move and what
  /// its frames cost, where frames of one topology follow each other.
  std::optional<double> skin{};
};

/// Memory and work of an engine since its last update.
struct EngineFacts {
  std::uint32_t thread_count = 1;  ///< that updates and queries use at most
  std::size_t memory_bytes = 0;    ///< for its fibres, the fibres themselves apart
  std::uint32_t level_count = 0;   ///< of the hierarchy, 0 if there is none

  /// How many of the hierarchy's cages the last update computed anew: all of them, except where
  /// cascade verification (Sect. 3.3) shows that the old ones hold.
  std::uint64_t recomputed_count = 0;

  /// [s] What the last update and the last query took on a GPU, without what went over to it and
  /// back; 0 of engines that use none.
  double device_seconds = 0.0;
};

/// Answers proximity queries over one assembly at a time. All engines give the same contacts; they
/// differ in what an update and a query cost.
class ProximityEngine {
 public:
  ProximityEngine();
  virtual ~ProximityEngine();
  ProximityEngine(const ProximityEngine&) = delete;
  ProximityEngine& operator=(const ProximityEngine&) = delete;

  /// Makes these fibres the ones queries are about. The engine refers to them until the next
  /// update: they must live, unchanged, until then. Without a change of topology nothing is
  /// allocated.
  void update(const FiberAssembly& fibers);
  void update(FiberAssembly&&) = delete;

  /// Those of the last update; nullptr if there was none, or since a motion.
  const FiberAssembly* fibers() const { return fibers_; }

  /// Pairs of segments of these fibres.
  /// @throws std::invalid_argument for options that do not validate
  void query(const QueryOptions& options, QueryResult& result) const;

  /// Pairs of a segment of the shape (a) and one of the fibres (b); the neighbour skips do not
  /// apply.
  /// @throws std::invalid_argument for options that do not validate
  void query_shape(const FiberAssembly& shape, const QueryOptions& options,
                   QueryResult& result) const;

  /// Makes this motion the one that query_motion() is about: every point moves linearly from where
  /// it is before to where it is after. Of each segment the larger radius counts. The engine refers
  /// to both until the next update. There are no fibres for query() then.
  /// @throws std::invalid_argument if the two are not of one topology, or a segment moves further
  ///         than SweptFibers allows
  void update_motion(const FiberAssembly& before, const FiberAssembly& after);
  void update_motion(FiberAssembly&&, const FiberAssembly&) = delete;
  void update_motion(const FiberAssembly&, FiberAssembly&&) = delete;

  /// Pairs of segments of these fibres that come into contact during the motion, and when. No
  /// contact is missed, and each time has proven bounds: see contact_time().
  /// @throws std::invalid_argument for options that do not validate
  void query_motion(const MotionOptions& options, MotionResult& result) const;

  /// Pairs of a segment of a shape (a), which moves as well, and one of the fibres (b); the
  /// neighbour skips and the pairing do not apply.
  /// @throws std::invalid_argument for options that do not validate, or as update_motion()
  void query_motion_shape(const FiberAssembly& shape_before, const FiberAssembly& shape_after,
                          const MotionOptions& options, MotionResult& result) const;

  virtual EngineFacts facts() const { return {}; }

  /// Mean volume of the cages of a level [m³] (paper, Fig. 5), those of level_boxes() if the engine
  /// has no others; 0 without a hierarchy.
  virtual double mean_level_volume(std::uint32_t level) const;

  /// Boxes around the nodes of a level, and around leaves above it, so that together they hold all
  /// fibres; 0 is the root, levels beyond the last give the last.
  virtual void level_boxes(std::uint32_t /*level*/, std::vector<NodeBox>& boxes) const {
    boxes.clear();
  }

 protected:
  virtual void do_update(const FiberAssembly& fibers, bool same_topology) = 0;
  virtual void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                        QueryResult& result) const = 0;
  virtual void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                              const QueryOptions& options, QueryResult& result) const = 0;

  // Motions: any engine can find candidates among swept fibres as it finds contacts.

  virtual void do_update_motion(const FiberAssembly& before, const FiberAssembly& after,
                                bool same_topology);

  /// Pairs of segments whose gap comes down to the test's margin, but for those that the test
  /// leaves out; others may be among them.
  /// @param shape that moves: pairs are of a segment of it (a) and one of the fibres (b); null for
  ///              pairs of the fibres
  virtual void do_find_candidates(const FiberMotion* shape, const NarrowPhase& test,
                                  const QueryLimits& limits, MotionCandidates& candidates) const;
  /// The loops of the fibres before the motion, nullptr if nothing is known of them.
  virtual const LoopTest* loops_before() const { return nullptr; }
  /// Works on as many threads as this engine may use.
  virtual void on_threads(const std::function<void()>& work) const;

 private:
  struct Motion;

  template <class Update>
  void update_from(const FiberAssembly& fibers, const Update& update);
  void find_motions(const FiberMotion* shape, const MotionOptions& options,
                    MotionResult& result) const;

  const FiberAssembly* fibers_ = nullptr;
  bool has_hierarchy_ = false;
  std::vector<std::uint32_t> offsets_;       // of the fibres that it is of
  std::shared_ptr<const FiberGraph> graph_;  // of these, if they have one
  std::unique_ptr<Motion> motion_;           // none until there is one
};

/// The engine of this name: run_tree, brute_force, or one of a registered family. The paper's are
/// there after register_paper_engines() (paper/paper_engines.hpp).
/// @throws std::invalid_argument listing the names, or for options that are not allowed
std::unique_ptr<ProximityEngine> make_engine(const std::string& name,
                                             const EngineOptions& options = {});

/// Names of all engines there are: run_tree, brute_force and those of the registered families.
std::vector<std::string> engine_names();

/// Engines that make_engine() can make, beside those of this library.
struct EngineFamily {
  /// Names that engine_names() lists, in this order.
  std::vector<std::string> names;

  /// Makes the engine of a name: one of `names`, or another that the family knows.
  /// @return nullptr for a name that is none of the family's
  /// @throws std::invalid_argument for a name that would be one but for a number in it, saying why
  std::function<std::unique_ptr<ProximityEngine>(const std::string& name,
                                                 const EngineOptions& options)>
      make;

  /// The other names it knows, as an error message lists them; may be empty.
  std::string other_names;
};

/// Adds a family, for the rest of the process. Safe from several threads. A library offers a
/// function that calls this: a linker may drop a library of which nothing is called, and its static
/// variables with it.
/// @return true, so that the initialiser of a program's static variable can call it
bool register_engines(EngineFamily family);

/// The k segments of the engine's fibres whose surfaces are nearest to a point, or all of them if
/// there are fewer; nearest first, ties by fibre and segment.
///
/// In the contacts b is the segment and a the point: `fiber_a`, `segment_a` and `s` are 0,
/// `point_a` is the point, `distance` is negative inside the segment [m]. The same as a LIMITED
/// query about a shape that is this point, without a margin.
/// @param point [m]
/// @param k     at least 1
/// @throws std::invalid_argument naming what is wrong: k of 0, a coordinate that is not finite or
///         above FiberAssembly::max_coordinate
/// @throws std::logic_error before the engine's first update
void nearest_segments(const ProximityEngine& engine, const Eigen::Vector3d& point, std::uint32_t k,
                      QueryResult& result);

}  // namespace fiber
