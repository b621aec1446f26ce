#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// Pairs as keys, in the order of the contacts.
inline std::uint64_t key_of(PointPair pair) { return std::uint64_t{pair.a} << 32U | pair.b; }
inline PointPair pair_of(std::uint64_t key) {
  return {static_cast<std::uint32_t>(key >> 32U), static_cast<std::uint32_t>(key)};
}

/// Makes contacts of candidates, slice by slice on several threads. Gives the same for any number
/// of threads. Keeps its memory from query to query.
class ContactJudge {
 public:
  /// @param keys of the candidates, as PairTest orders pairs, in ascending order
  /// @param bound [m] pairs of a signed distance of at most this are contacts
  /// @param contacts what they held is replaced
  void judge(const std::vector<std::uint64_t>& keys, const PairTest& test, double bound,
             std::vector<Contact>& contacts);

 private:
  std::size_t judge_round(const std::uint64_t* keys, std::size_t count, const PairTest& test,
                          double bound, std::vector<Contact>& contacts, std::size_t contact_count);

  std::vector<PairDistance> distances_;  // of a round
  std::vector<std::size_t> places_;      // of its slices' contacts
};

}  // namespace fiber
