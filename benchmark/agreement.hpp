#pragma once

#include <cstdint>
#include <string>

#include "fiber_proximity/query/contact.hpp"

namespace fiber {

/// Compares every answer of a frame with the one before. Only two are kept, in memory that all
/// engines share: the contacts of a whole head take a gigabyte.
class Agreement {
 public:
  void begin_frame(std::uint32_t frame);

  /// Where the next answer goes.
  QueryResult& next() { return next_; }

  /// The answer is there: it becomes the one before.
  /// @param name of who has given it
  void check(const std::string& name);

  /// Where two answers differ first; empty when none do.
  const std::string& disagreement() const { return disagreement_; }

 private:
  QueryResult previous_;
  QueryResult next_;
  std::string previous_name_;  // empty before the first answer of a frame
  std::uint32_t frame_ = 0;
  std::string disagreement_;
};

}  // namespace fiber
