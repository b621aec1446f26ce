#pragma once

#include <mpi.h>

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <tuple>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// The name of a part of a fibre that a rank brings: the fibre, and the index along it of the
/// part's first segment, both from 0. Fibres may have any numbers; contacts are sorted by them.
struct FiberPart {
  std::uint64_t fiber = 0;
  std::uint64_t first_segment = 0;

  bool operator==(const FiberPart& other) const {
    return fiber == other.fiber && first_segment == other.first_segment;
  }
};

/// The fibres that a rank brings to DistributedEngine::update().
struct DistributedFibers {
  FiberAssembly parts;
  std::vector<FiberPart> names;  ///< one per part

  /// Names of the fibres by number, the same on all ranks: for files and answers.
  FiberNames fiber_names{};

  /// The joined points, of fibres that are cut into parts as well. `closed` is by part, whether its
  /// fibre is closed: the fibre's last point is then its first one, repeated, and has its joint.
  /// `joints` is by point of the parts, and points of one number are one place on whatever ranks
  /// they are. Empty for chains, and where the parts are closed or joined themselves.
  FiberTopology topology{};
};

/// A contact whose fibres and segments have the numbers that hold for all ranks.
using DistributedContact = BasicContact<std::uint64_t>;

/// A rank's part of an answer.
struct DistributedResult {
  /// Pairs whose smaller segment this rank owns, sorted by key().
  std::vector<DistributedContact> contacts;

  // The rest is the same on all ranks.

  bool limit_reached = false;  ///< as in QueryResult
  bool complete = true;        ///< as in QueryResult

  /// [m] Of the pairs that were asked about, none that no rank reports has a smaller true gap.
  double others_lower = -std::numeric_limits<double>::infinity();
};

/// A contact during a motion, with the numbers that hold for all ranks.
using DistributedMotionContact = BasicMotionContact<std::uint64_t>;

/// A rank's part of an answer about a motion.
struct DistributedMotionResult {
  /// Pairs whose smaller segment this rank owns; otherwise as in MotionResult.
  std::vector<DistributedMotionContact> contacts;
  std::vector<DistributedMotionContact> touching;

  // The rest is the same on all ranks, and as in MotionResult.

  bool limit_reached = false;
  bool complete = true;
  double others_lower = 0.0;
};

/// Sizes and counts of a rank.
struct DistributedFacts {
  std::uint64_t own_segments = 0;   ///< that the split gave to this rank
  std::uint64_t halo_segments = 0;  ///< of other ranks, for the last query
  std::uint64_t split_count = 0;    ///< how often fibres were split among the ranks

  /// Points that this rank brought with the last update and others hold.
  std::uint64_t sent_points = 0;

  /// How often ranks looked for what others need. What they find serves until points have moved.
  std::uint64_t halo_search_count = 0;

  /// Work of this rank for queries since the last update.
  QueryCounts query_counts;

  /// Segments of closed and joined fibres that this rank knows whole, its own among them.
  std::uint64_t joined_segments = 0;
};

/// Contacts of fibres that are spread over the ranks of MPI, the same, bit for bit, as one process
/// finds, for any number of ranks and any parts that they bring.
///
/// The fibres are cut into pieces of a few segments, which are split among the ranks along a
/// space-filling curve, by Zoltan. For a query each rank gets from others what may come within the
/// margin of its own; while that is on its way it asks an engine run_tree about its own fibres, and
/// then about what has come. Distances are computed from the points as they were brought, by
/// whoever has both segments.
///
/// All functions but facts() are collective: all ranks of the communicator call them, in the same
/// order, or they wait for each other. An error of one rank is thrown by all, with its number; but
/// where Zoltan fails on one rank and others wait for it there, it ends all by MPI_Abort().
/// Not thread-safe; only the thread that calls talks to MPI, which must have been started with
/// MPI_THREAD_FUNNELED or more. Must be destroyed before MPI_Finalize().
class DistributedEngine {
 public:
  /// @param ranks   a communicator; the engine works on a copy of it, so that messages do not meet
  /// @param options of each rank's own engine; give `threads` where ranks share a machine
  /// @throws std::logic_error if MPI is not running, or without thread support
  /// @throws std::invalid_argument for options that are not allowed
  explicit DistributedEngine(MPI_Comm ranks, const EngineOptions& options = {});
  ~DistributedEngine();
  DistributedEngine(const DistributedEngine&) = delete;
  DistributedEngine& operator=(const DistributedEngine&) = delete;

  /// Makes the parts of all ranks the fibres queries are about; copies them.
  ///
  /// Together, the parts make whole fibres: each segment is in one part, of any rank. Where a fibre
  /// goes on in another part, its last point is the first point of that, and both ranks bring it.
  /// Parts of the same names and numbers of points, on all ranks, as at the last update are taken
  /// for the same fibres, moved: they stay with the ranks that have them, until what these have
  /// had to do since the last update differs too much.
  ///
  /// Fibres may be closed and joined: by the parts themselves where a closed fibre is one part, the
  /// numbers of joints being those of all ranks, or else by the topology. A rank that owns a
  /// segment of such a fibre gets it whole with each update, and all fibres that are joined with
  /// it.
  /// @param parts    of this rank, each as a fibre, in any order, or none; a radius per fibre or
  ///                 point as FiberAssembly has it [m]
  /// @param names    one per part
  /// @param topology of these parts, see DistributedFibers
  /// @throws std::invalid_argument if there are not as many names as parts, where segments are
  ///         brought twice or are missing, where two parts of a fibre do not meet or are not joined
  ///         alike, and as FiberAssembly for fibres that are closed or joined; then the engine has
  ///         no fibres
  void update(const FiberAssembly& parts, const std::vector<FiberPart>& names,
              const FiberTopology& topology = {});

  /// Makes what each rank holds the parts that it brings. A simulation that goes on with these
  /// sends no points but those of halos, until fibres are split anew: then those that change hands.
  /// @return the parts, as the last update had them, and what they are called. Their radii are of
  ///         segments, so FiberAssembly::update_points() moves them. Later updates that bring parts
  ///         of these names and numbers of points are of the same fibres
  /// @throws std::logic_error before the first update, and after one of a motion
  DistributedFibers adopt();

  /// Pairs of segments of all fibres within the margin, each reported by the rank that holds the
  /// smaller of the two, by fibre and index. Options mean what they do for
  /// ProximityEngine::query(); which segments of one fibre are pairs is decided by whole fibres.
  ///
  /// CLOSEST and LIMITED get a bound from pairs that ranks know of, and need no more of others than
  /// what may be nearer than that. So does FIBER_PAIRS without a margin (infinity) where ranks know
  /// a pair of each two fibres; otherwise, and FIRST where there is no pair, it needs all within
  /// the margin, and infinity brings all segments to all ranks.
  /// @param options the same on all ranks. Tolerances are not used: the closest pairs are found.
  ///                Each rank examines its share of the pair_limit; which pairs come up, then and
  ///                by a deadline, and which one FIRST reports, depends on the number of ranks
  /// @throws std::invalid_argument for options that do not validate or that differ between ranks,
  ///         and where a rank would hold more than 2³¹ points
  /// @throws std::logic_error before the first update
  void query(const QueryOptions& options, DistributedResult& result);

  /// Makes the motion of all parts, from where they are before to where they are after, the one
  /// that query_motion() is about. There are no fibres for query() then. Otherwise as update().
  /// @throws std::invalid_argument as update(), and as ProximityEngine::update_motion()
  void update_motion(const FiberAssembly& before, const FiberAssembly& after,
                     const std::vector<FiberPart>& names, const FiberTopology& topology = {});

  /// Pairs of segments of all fibres that come into contact during the motion, and when; each
  /// reported by the rank that holds the smaller of the two.
  /// @param options the same on all ranks; the pair_limit and the deadline as for query()
  /// @throws std::invalid_argument for options that do not validate or that differ between ranks,
  ///         and where a rank would hold more than 2³¹ points
  /// @throws std::logic_error if the last update was of no motion
  void query_motion(const MotionOptions& options, DistributedMotionResult& result);

  DistributedFacts facts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Brings the answers of all ranks together on one, sorted. Collective.
/// @param root the rank that gets all; must be one of the communicator's
/// @return all contacts on that rank, none on the others
DistributedResult gather(MPI_Comm ranks, const DistributedResult& result, int root = 0);

/// Deals the contacts of all ranks out anew, sorted by key(): those of a rank
/// come before those of the next, and none has more than about twice as many as there are for each.
/// Collective.
void sort_over_ranks(MPI_Comm ranks, DistributedResult& result);
void sort_over_ranks(MPI_Comm ranks, DistributedMotionResult& result);

}  // namespace fiber
