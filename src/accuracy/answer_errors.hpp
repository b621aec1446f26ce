#pragma once

#include <algorithm>
#include <cstddef>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// The errors of an answer, or of several: the largest of each kind, and counts in all.
struct AnswerErrors {
  std::size_t expected = 0;      ///< contacts of the exact answers
  std::size_t missed = 0;        ///< of these not reported, in answers that were complete
  std::size_t cut_off = 0;       ///< of these not reported, in answers that were not
  std::size_t extra = 0;         ///< reported, though not among them
  std::size_t wrong_bounds = 0;  ///< answers whose bounds exclude the exact distance
  double error = 0.0;            ///< [m] of a distance; of CLOSEST, of the minimum
  double bound = 0.0;            ///< [m] that an answer stated for it

  /// [m] How far within the margin the nearest contact is that was not reported, or how far beyond
  /// it one that was.
  double decision_error = 0.0;

  void add(const AnswerErrors& other);

  /// The part of the exact contacts that was reported.
  double found_part() const;

  /// The largest error of distances and decisions [m].
  double largest() const { return std::max(error, decision_error); }
};

/// Holds an answer against the exact answer to the same query. Distances are checked by integers,
/// at most so many of them, and all others by those of the exact answer, where it has them.
/// @param exact of the kernel EXACT, without tolerance and deadline
/// @param max_checked how many distances
AnswerErrors answer_errors(const FiberAssembly& fibers, const QueryOptions& options,
                           const QueryResult& answer, const QueryResult& exact,
                           std::size_t max_checked = 1000);

/// Holds an answer about the same fibres with fewer points against the exact answer about all
/// points. Segments are others then, so only distances count: of the closest pair (CLOSEST), or of
/// each pair of fibres (FIBER_PAIRS). No bounds are stated.
AnswerErrors resampled_errors(const QueryOptions& options, const QueryResult& answer,
                              const QueryResult& exact);

}  // namespace fiber
