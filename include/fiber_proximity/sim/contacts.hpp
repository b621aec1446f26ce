#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/sim/effects/friction.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

class ContactSet;
struct Room;

/// A contact effect: it knows what rods may touch.
class ContactSource {
 public:
  virtual ~ContactSource() = default;

  /// Finds what rods may touch in a step.
  /// @param rods where they are when it begins
  /// @param room how far they may go
  /// @param found appended to
  virtual void find(const Rods& rods, const Room& room, ContactSet& found) = 0;
};

/// All contacts of a simulation: what couples one rod to another.
class Contacts {
 public:
  /// @param friction null for none
  Contacts(std::vector<std::unique_ptr<ContactSource>> sources, std::unique_ptr<Friction> friction)
      : sources_(std::move(sources)), friction_(std::move(friction)) {}

  const std::vector<std::unique_ptr<ContactSource>>& sources() const { return sources_; }
  const Friction* friction() const { return friction_.get(); }

 private:
  std::vector<std::unique_ptr<ContactSource>> sources_;
  std::unique_ptr<Friction> friction_;
};

}  // namespace fiber
