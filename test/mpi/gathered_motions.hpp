#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "test/mpi/scattered_fibers.hpp"

namespace fiber::test {

/// The contacts of all ranks, sorted, on every rank.
inline std::vector<DistributedMotionContact> gathered(
    const std::vector<DistributedMotionContact>& mine) {
  const Communicator ranks(MPI_COMM_WORLD);
  std::vector<DistributedMotionContact> all = joined(ranks.exchange(
      PerRank<DistributedMotionContact>(static_cast<std::size_t>(ranks.size()), mine)));
  std::sort(all.begin(), all.end(), by_key);
  return all;
}

inline testing::AssertionResult same_as_one_process(
    const std::vector<DistributedMotionContact>& mine, const std::vector<MotionContact>& expected) {
  const std::vector<DistributedMotionContact> found = gathered(mine);
  if (found.size() != expected.size()) {
    return testing::AssertionFailure() << found.size() << " contacts, expected " << expected.size();
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const DistributedMotionContact& x = found[i];
    const MotionContact& y = expected[i];
    if (x.fiber_a != name_of_fiber(y.fiber_a) || x.segment_a != y.segment_a ||
        x.fiber_b != name_of_fiber(y.fiber_b) || x.segment_b != y.segment_b ||
        !same_bits(x.lower, y.lower) || !same_bits(x.upper, y.upper) || x.certain != y.certain) {
      return testing::AssertionFailure()
             << "contact " << i << " is (" << x.fiber_a << ", " << x.segment_a << ", " << x.fiber_b
             << ", " << x.segment_b << ") from " << x.lower << " to " << x.upper;
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace fiber::test
