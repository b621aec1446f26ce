#include "fiber_proximity/query/fiber_pair_minima.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace fiber {
namespace {

constexpr std::size_t first_slot_count = 64;  // a power of two, as all later ones

/// Fibonacci hashing: the high bits of the product depend on all bits of the fibres.
std::size_t hash(std::uint32_t fiber_a, std::uint32_t fiber_b) {
  const std::uint64_t key = std::uint64_t{fiber_a} << 32U | fiber_b;
  return static_cast<std::size_t>((key * 0x9E37'79B9'7F4A'7C15U) >> 32U);
}

}  // namespace

const Contact* FiberPairMinima::find(std::uint32_t fiber_a, std::uint32_t fiber_b) {
  if ((fiber_a != last_a_ || fiber_b != last_b_) && !contacts_.empty()) {
    const std::uint32_t entry = slots_[slot_of(fiber_a, fiber_b)];
    last_ = entry == 0 ? nullptr : &contacts_[entry - 1];
  }
  last_a_ = fiber_a;
  last_b_ = fiber_b;
  return last_;
}

void FiberPairMinima::keep(const Contact& contact) {
  assert(contact.fiber_a == last_a_ && contact.fiber_b == last_b_);
  if (last_ != nullptr) {
    if (contact.closer_than(*last_)) {
      *last_ = contact;
    }
    return;
  }
  if (contacts_.empty() || 2 * contacts_.size() >= slots_.size()) {
    grow();
  }
  assert(contacts_.size() < std::numeric_limits<std::uint32_t>::max());
  contacts_.push_back(contact);
  slots_[slot_of(contact.fiber_a, contact.fiber_b)] = static_cast<std::uint32_t>(contacts_.size());
  last_ = &contacts_.back();
}

/// The slot of this pair of fibres, or the free one it is to have.
std::size_t FiberPairMinima::slot_of(std::uint32_t fiber_a, std::uint32_t fiber_b) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(fiber_a, fiber_b) & mask;
  while (slots_[slot] != 0) {
    const Contact& contact = contacts_[slots_[slot] - 1];
    if (contact.fiber_a == fiber_a && contact.fiber_b == fiber_b) {
      break;
    }
    slot = (slot + 1) & mask;
  }
  return slot;
}

/// Twice as many slots; the first ones for the first contact, as slots may be left of a query
/// before.
void FiberPairMinima::grow() {
  slots_.resize(contacts_.empty() ? first_slot_count : 2 * slots_.size());
  fill_slots();
}

void FiberPairMinima::contacts_have_moved() {
  fill_slots();
  const std::uint32_t entry = slots_[slot_of(last_a_, last_b_)];
  last_ = entry == 0 ? nullptr : &contacts_[entry - 1];
}

void FiberPairMinima::fill_slots() {
  std::fill(slots_.begin(), slots_.end(), 0);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    slots_[slot_of(contacts_[i].fiber_a, contacts_[i].fiber_b)] = static_cast<std::uint32_t>(i + 1);
  }
}

}  // namespace fiber
