#include "fiber_proximity/query/motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace fiber {

QueryOptions pairs_of(const MotionOptions& options) {
  QueryOptions pairs;
  pairs.margin = options.margin;
  pairs.pairing = options.pairing;
  pairs.neighbour_skip = options.neighbour_skip;
  pairs.neighbour_skip_length = options.neighbour_skip_length;
  pairs.deadline = options.deadline;
  pairs.contact_limit = options.contact_limit;
  pairs.pair_limit = options.pair_limit;
  return pairs;
}

MotionOptions motion_options(const QueryOptions& options, double tolerance) {
  MotionOptions motion;
  if (options.type == QueryType::FIRST || options.type == QueryType::CLOSEST) {
    motion.type = MotionType::FIRST;
  } else if (options.type == QueryType::LIMITED) {
    motion.type = MotionType::LIMITED;
  }
  motion.margin = options.margin;
  motion.tolerance = tolerance;
  motion.max_contacts = options.max_contacts;
  motion.pairing = options.pairing;
  motion.neighbour_skip = options.neighbour_skip;
  motion.neighbour_skip_length = options.neighbour_skip_length;
  motion.deadline = options.deadline;
  motion.contact_limit = options.contact_limit;
  motion.pair_limit = options.pair_limit;
  return motion;
}

void validate(const MotionOptions& options) {
  QueryOptions pairs = pairs_of(options);
  pairs.tolerance = options.tolerance;
  validate(pairs);
  if (!(options.time_tolerance >= 0.0)) {
    throw std::invalid_argument("time_tolerance is " + std::to_string(options.time_tolerance) +
                                ", it must be at least 0 (infinity for none)");
  }
  if (options.type == MotionType::LIMITED && options.max_contacts == 0) {
    throw std::invalid_argument("max_contacts is 0, a limited query needs at least 1");
  }
}

const MotionContact* MotionResult::earliest() const {
  return earliest([](const MotionContact& /*contact*/) { return true; });
}

}  // namespace fiber
