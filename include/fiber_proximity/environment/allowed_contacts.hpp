#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/environment/allowed_pairs.hpp"

namespace fiber {

/// An AllowedPair whose fibre is named; neither object nor fibre need be there already.
struct NamedPair {
  std::string object;  ///< empty for every one
  std::string fiber;   ///< empty for every one

  /// First and last segment of a part of the fibre, as AllowedPair has them; empty for all of it.
  std::vector<std::int32_t> segments;
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
  struct Change {
    bool reset = false;             ///< forget all pairs first
    std::vector<NamedPair> forbid;  ///< take back
    std::vector<NamedPair> allow;
  };

  /// Does all of a change, or nothing.
  /// @throws std::invalid_argument naming the pair, as validate(), or to take back one that is not
  ///         allowed
  void apply(const Change& change);

  const std::vector<NamedPair>& pairs() const { return pairs_; }

 private:
  std::vector<NamedPair> pairs_;
};

}  // namespace fiber
