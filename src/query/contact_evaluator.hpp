#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/hierarchy/pair_bound.hpp"

namespace fiber {

/// Makes contacts of candidates, slice by slice on several threads. Gives the same for any number
/// of threads. Keeps its memory from query to query.
class FIBER_PROXIMITY_EXPORT ContactEvaluator {
 public:
  /// Candidates are judged until this part of the time has passed; then contacts are written.
  static constexpr double part_of_time = 0.9;

  /// @param keys of the candidates, as NarrowPhase orders pairs, in ascending order
  /// @param result its contacts and others_lower are replaced; complete becomes false if the
  /// deadline has passed before all were evaluated, and is to be false if some candidates are
  /// missing; limit_reached becomes true if there are more contacts than may be reported. Both do
  /// if candidates take so many steps along fibres that they count as too many pairs
  void evaluate(const std::vector<std::uint64_t>& keys, const NarrowPhase& test,
                const QueryLimits& limits, QueryResult& result);

 private:
  /// 512 candidates: what one thread evaluates at a time.
  struct Slice {
    std::size_t begin = 0;  // of its candidates in the round
    std::size_t end = 0;
    std::size_t place = 0;  // of its first contact
    std::size_t contact_count = 0;
    double others_lower = 0.0;     // [m]
    std::uint64_t loop_steps = 0;  // along fibres
    bool took_too_long = false;
    bool complete = true;
  };

  void evaluate_round(const std::uint64_t* keys, std::size_t count, const NarrowPhase& test,
                      const QueryLimits& limits, QueryResult& result);
  void make_room(std::size_t evaluated, std::size_t candidates, const QueryLimits& limits,
                 std::vector<Contact>& contacts) const;
  void report(const std::uint64_t* keys, const NarrowPhase& test,
              std::vector<Contact>& contacts) const;
  void leave_closest(std::uint64_t count, QueryResult& result);
  void evaluate_slice(const std::uint64_t* keys, const NarrowPhase& test,
                      std::uint64_t loop_steps_left, Slice& slice);

  // These are of a round.
  std::vector<Slice> slices_;
  std::vector<PairDistance> distances_;
  std::vector<std::uint8_t> is_contact_;

  // These are of all rounds so far.
  std::size_t contact_count_ = 0;
  std::uint64_t loop_steps_ = 0;  // along fibres
  bool took_too_long_ = false;
  double bound_ = 0.0;  // [m] so many are within it that pairs beyond are not reported
};

}  // namespace fiber
