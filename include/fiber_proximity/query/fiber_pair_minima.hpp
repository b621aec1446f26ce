#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// The closest contact of each pair of fibres so far, among the contacts of a result.
///
/// A hash table with linear probing finds a pair's contact. Traversals offer the segments of two
/// fibres in a row, so the last pair of fibres is remembered and most look-ups need no table.
/// Holds references: assemblies and result must outlive it. Until the first keep() it costs
/// nothing.
class FiberPairMinima {
 public:
  /// @param a, b the fibres of a pair's first and second segment; the same ones, or a shape's
  FiberPairMinima(const FiberAssembly& a, const FiberAssembly& b, QueryResult& result)
      : fiber_a_(a), fiber_b_(b), contacts_(result.contacts), slots_(result.fiber_pair_slots) {}

  /// The closest contact so far of the fibres that own these segments, nullptr if there is none.
  const Contact* find(PointPair pair);

  /// Keeps a contact of the pair last looked for, unless one is kept that is closer, or as close
  /// and of smaller indices.
  void keep(const Contact& contact);

 private:
  /// Finds the fibre of a point; at once if it is that of the point before.
  class FiberFinder {
   public:
    explicit FiberFinder(const FiberAssembly& fibers) : fibers_(fibers) {}
    /// Whether the fibre is another one than before.
    bool move_to(std::uint32_t point);
    std::uint32_t fiber() const { return fiber_; }

   private:
    const FiberAssembly& fibers_;
    std::uint32_t fiber_ = 0;
    std::uint32_t begin_ = 0;  // of its points; none yet
    std::uint32_t end_ = 0;
  };

  std::size_t slot_of(std::uint32_t fiber_a, std::uint32_t fiber_b) const;
  void grow();

  FiberFinder fiber_a_;
  FiberFinder fiber_b_;
  std::vector<Contact>& contacts_;
  std::vector<std::uint32_t>& slots_;  // index of a contact + 1, 0 where free
  Contact* last_ = nullptr;
};

}  // namespace fiber
