#pragma once

#include "fiber_proximity/geometry/contact_time.hpp"

namespace fiber {

/// contact_time() in numbers of twice the digits, from a time until which there is no contact.
ContactTime wide_contact_time(const SegmentMotions& motions, double tolerance, double time);

}  // namespace fiber
