#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/AllowPairs.h"
#include "fiber_proximity/AllowedPair.h"
#include "fiber_proximity/environment/allowed_pairs.hpp"

namespace fiber_proximity_ros {

/// @throws std::invalid_argument naming object and fibre, for segments that are not the first and
///         the last of a part
void validate(const fiber_proximity::AllowedPair& pair);

/// Which objects may touch which parts of fibres. Neither object nor fibre need be there already.
class AllowedContacts {
 public:
  /// Does what a request asks for, or nothing.
  /// @throws std::invalid_argument naming the pair
  void apply(const fiber_proximity::AllowPairs::Request& request);

  const std::vector<fiber_proximity::AllowedPair>& pairs() const { return pairs_; }

  /// The pairs for these fibres; a name may be that of several.
  fiber::AllowedPairs resolve(const std::vector<std::string>& fiber_names) const;

 private:
  std::vector<fiber_proximity::AllowedPair> pairs_;
};

}  // namespace fiber_proximity_ros
