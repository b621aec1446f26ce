#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"

namespace fiber {

/// An AllowedPair whose fibre is named; neither object nor fibre need be there already.
struct NamedPair {
  std::string object;  ///< empty for every one
  std::string fiber;   ///< empty for every one

  /// First and last segment of a part of the fibre, as AllowedPair has them; empty for all of it.
  std::vector<std::int32_t> segments;

  bool operator<(const NamedPair& other) const {
    return std::tie(object, fiber, segments) < std::tie(other.object, other.fiber, other.segments);
  }
};

/// @throws std::invalid_argument naming object and fibre, for segments that are not the first and
///         the last of a part
void validate(const NamedPair& pair);

/// The pairs for these fibres; a name may be that of several.
AllowedPairs resolve(const std::vector<NamedPair>& pairs,
                     const std::vector<std::string>& fiber_names);

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
