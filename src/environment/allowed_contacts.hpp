#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"

namespace fiber {

/// Which objects may touch which parts of fibres, each pair once.
class AllowedContacts {
 public:
  /// Takes back pairs and allows others, or does nothing.
  /// @param reset forgets all pairs first
  /// @throws std::invalid_argument naming the pair, as validate(), or to take back one that is not
  ///         allowed
  void apply(bool reset, const std::vector<NamedPair>& forbid, const std::vector<NamedPair>& allow);

  const std::vector<NamedPair>& pairs() const { return pairs_; }

 private:
  std::vector<NamedPair> pairs_;
};

/// Pairs that may touch, sorted so that it is quickly known of a segment and an object.
class AllowedParts {
 public:
  AllowedParts(const AllowedPairs& allowed, const std::vector<EnvironmentObject>& objects);

  /// Whether this segment may touch the object of this index.
  bool holds(const FiberAssembly& fibers, SegmentId segment, std::uint32_t object) const;

 private:
  /// A part of a fibre that may touch an object: as AllowedPair has it.
  struct Part {
    std::uint32_t fiber;
    std::int64_t first_segment;
    std::int64_t last_segment;
  };
  struct OfFiber;

  // By object, behind them those of every object, each sorted by fibre; empty if there are none.
  std::vector<std::vector<Part>> parts_;
};

}  // namespace fiber
