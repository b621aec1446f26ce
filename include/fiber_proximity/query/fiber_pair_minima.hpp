#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/query/contact.hpp"

namespace fiber {

/// The closest contact of each pair of fibres so far, among the contacts of a result.
///
/// A hash table with linear probing finds a pair's contact. Traversals find the pairs of two fibres
/// in a row, so the last pair of fibres is remembered and most look-ups need no table. Holds a
/// reference: the result must outlive it. Until the first keep() it costs nothing.
class FiberPairMinima {
 public:
  explicit FiberPairMinima(QueryResult& result)
      : contacts_(result.contacts), slots_(result.fiber_pair_slots) {}

  /// The closest contact so far of these fibres, nullptr if there is none.
  const Contact* find(std::uint32_t fiber_a, std::uint32_t fiber_b);

  /// Keeps a contact of the pair last looked for, unless one is kept that is closer, or as close
  /// and of smaller indices.
  void keep(const Contact& contact);

  /// To be called when some contacts have been taken out of the result, or have changed places.
  void contacts_have_moved();

 private:
  std::size_t slot_of(std::uint32_t fiber_a, std::uint32_t fiber_b) const;
  void grow();
  void fill_slots();

  std::vector<Contact>& contacts_;
  std::vector<std::uint32_t>& slots_;  // index of a contact + 1, 0 where free
  Contact* last_ = nullptr;
  std::uint32_t last_a_ = 0;  // fibres of the last look-up
  std::uint32_t last_b_ = 0;
};

}  // namespace fiber
