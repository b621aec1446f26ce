#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber_proximity_ros {

/// How far the true points of fibres may be from those that were told, and what follows for pairs.
///
/// A point of a segment's axis is a convex combination of its two ends. Where the true ends are
/// within u of the told ones, so is every point of the true axis. The true gap of two bodies is
/// therefore within u_a + u_b of the told one, whichever way their points are off.
///
/// Which segments of one fibre are pairs is judged by the told points (LoopTest, neighbour skips).
class Uncertainty {
 public:
  /// Tells which bodies of a contact are such fibres. The others are known exactly.
  enum class Bodies { A, B, BOTH };

  /// No body is uncertain.
  Uncertainty() = default;

  /// @param of_fibers [m] by fibre, finite and at least 0; empty where none is uncertain
  Uncertainty(std::vector<double> of_fibers, Bodies bodies);

  bool is_none() const { return of_fibers_.empty(); }

  /// [m] By which the true gap of these two may differ from the told one.
  double of_pair(const fiber::SegmentIdPair& pair) const;

  /// [m] The most of all pairs.
  double max() const { return max_; }

  /// [m] Pairs whose true gap may be within a margin are told to be within this one: a pair, or
  /// all.
  double possible_margin(double margin, const fiber::SegmentIdPair& pair) const;
  double possible_margin(double margin) const;

  /// [m] Pairs that are told to be within this one have a true gap within the margin; may be below
  /// 0.
  double certain_margin(double margin, const fiber::SegmentIdPair& pair) const;
  double certain_margin(double margin) const;

  /// Widens the bounds of the true gap.
  void widen(fiber::Contact& contact) const;

 private:
  double of_fiber(std::size_t fiber) const { return of_fibers_[fiber]; }

  std::vector<double> of_fibers_;
  Bodies bodies_ = Bodies::BOTH;
  double max_ = 0.0;
};

/// Whether the true gap of a contact is certain to be within the margin.
inline bool is_certain(const fiber::Contact& contact, double margin) {
  return contact.upper <= margin;
}

/// Asks an engine about the told fibres.
using Ask = std::function<void(const fiber::QueryOptions&, fiber::QueryResult&)>;

/// Asks for the pairs whose true gap may be within the margin. All bounds of the result hold for
/// the true gaps; distances, points and the order by distance are those of the told points. FIRST
/// reports any possible contact, CLOSEST and LIMITED those of the possible ones that are closest by
/// the told points, FIBER_PAIRS the one of each pair of fibres. A contact_limit counts the pairs
/// that come up, also those that turn out to be impossible.
///
/// Where nothing is uncertain, this is the query itself.
/// @returns whether pairs came up that are impossible, and are left out
bool query_possible(const fiber::QueryOptions& options, const Uncertainty& uncertainty,
                    const Ask& ask, fiber::QueryResult& result);

/// The fibres with radii that are larger by their uncertainty: they enclose the true ones.
/// @param of_fibers [m] by fibre
fiber::FiberAssembly enclosing_fibers(const fiber::FiberAssembly& fibers,
                                      const std::vector<double>& of_fibers);

/// The told contact of one whose body b is a fibre of enclosing_fibers(): bounds of the true gap,
/// and the distance and the points of the told fibre.
/// @param uncertainty [m] of b
fiber::Contact told_contact(fiber::Contact enclosing, double uncertainty);

}  // namespace fiber_proximity_ros
