#pragma once

#include <boost/shared_ptr.hpp>
#include <memory>

namespace fiber_proximity_ros {

/// Points to a part of a message, and keeps the message alive.
template <class Message, class Part>
std::shared_ptr<const Part> part_of(const boost::shared_ptr<const Message>& message,
                                    const Part& part) {
  return std::shared_ptr<const Part>(&part, [message](const Part* /*part*/) {});
}

}  // namespace fiber_proximity_ros
