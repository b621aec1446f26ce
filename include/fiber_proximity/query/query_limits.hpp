#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "fiber_proximity/query/deadline.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// What the options of a query allow it to cost: where it stops, and how much it may report. A
/// limit that is not set is one that nothing reaches.
struct QueryLimits {
  explicit QueryLimits(const QueryOptions& options)
      : deadline(options.deadline),
        pairs(options.pair_limit == 0 ? std::numeric_limits<std::uint64_t>::max()
                                      : options.pair_limit),
        contacts(most_contacts(options)),
        most_kept(std::max(2 * contacts, contacts + least_surplus)) {}

  Deadline deadline;
  std::uint64_t pairs;     ///< to be examined
  std::uint64_t contacts;  ///< to be reported

  /// Contacts that are kept at a time: so many more than reported that it is rarely asked which of
  /// them are the closest.
  std::uint64_t most_kept;

  /// Where a pair takes more looks along its fibre (LoopTest), each so many count as one more pair.
  static constexpr std::uint64_t looks_per_pair = 8;

  static constexpr std::uint64_t least_surplus = 1024;

 private:
  static std::uint64_t most_contacts(const QueryOptions& options) {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    const std::uint32_t limit = options.contact_limit == 0 ? none : options.contact_limit;
    return options.type == QueryType::LIMITED ? std::min(options.max_contacts, limit) : limit;
  }
};

}  // namespace fiber
