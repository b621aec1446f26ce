#pragma once

#include <utility>

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/FiberArray.h"

namespace fiber_proximity_rviz {

/// Fibres and the contacts among them, which come as two messages of one stamp, in either order.
struct FibersAndContacts {
  fiber_proximity::FiberArrayConstPtr fibers;      ///< null: nothing yet
  fiber_proximity::ContactArrayConstPtr contacts;  ///< null: none came with these fibres
};

/// Decides what to draw: the newest fibres whose contacts are there. Contacts that do not come are
/// waited for only so long, so that fibres are seen in any case.
class ContactPairing {
 public:
  /// [s] Fibres are kept back at most so long, counted from the last ones that were not.
  static constexpr double timeout = 0.5;

  void add(const fiber_proximity::FiberArrayConstPtr& fibers) {
    newest_.fibers = fibers;
    is_pending_ = true;
    match();
  }

  void add(const fiber_proximity::ContactArrayConstPtr& contacts) {
    newest_.contacts = contacts;
    match();
  }

  void clear() { *this = ContactPairing(); }

  /// Returns the fibres that have become ready since the last call; null fibres if none have.
  /// @param elapsed [s] since that call
  FibersAndContacts take(double elapsed) {
    if (is_pending_) {
      waited_ += elapsed;
      if (waited_ > timeout) {  // and stays so until contacts match: the next ones do not wait
        ready_ = {newest_.fibers, nullptr};
        is_pending_ = false;
      }
    }
    return std::exchange(ready_, FibersAndContacts());
  }

 private:
  void match() {
    if (newest_.fibers && newest_.contacts &&
        newest_.fibers->header.stamp == newest_.contacts->header.stamp) {
      ready_ = newest_;
      is_pending_ = false;
      waited_ = 0.0;
    }
  }

  FibersAndContacts newest_;  // not necessarily of one stamp
  FibersAndContacts ready_;
  bool is_pending_ = false;  // the newest fibres have not been handed out
  double waited_ = 0.0;
};

}  // namespace fiber_proximity_rviz
