#include "src/rviz/contact_pairing.hpp"

#include <utility>

namespace fiber_proximity_rviz {

void ContactPairing::add(const fiber_proximity::FiberArrayConstPtr& fibers) {
  newest_.fibers = fibers;
  fibers_wait_ = true;
  match();
}

void ContactPairing::add(const fiber_proximity::ContactArrayConstPtr& contacts) {
  newest_.contacts = contacts;
  match();
}

void ContactPairing::clear() { *this = ContactPairing(); }

void ContactPairing::match() {
  if (newest_.fibers && newest_.contacts &&
      newest_.fibers->header.stamp == newest_.contacts->header.stamp) {
    ready_ = newest_;
    fibers_wait_ = false;
    waited_ = 0.0;
  }
}

FibersAndContacts ContactPairing::take(double elapsed) {
  if (fibers_wait_) {
    waited_ += elapsed;
    if (waited_ > patience) {  // and stays so until contacts match: the next ones do not wait
      ready_ = {newest_.fibers, nullptr};
      fibers_wait_ = false;
    }
  }
  return std::exchange(ready_, FibersAndContacts());
}

}  // namespace fiber_proximity_rviz
