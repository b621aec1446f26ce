#include "src/ros/support/unknown.hpp"

#include <sstream>

namespace fiber_proximity_ros {

std::string text_of(const Unknown& unknown) {
  std::ostringstream text;
  text << unknown.what << " since " << unknown.since << ": " << unknown.why;
  return text.str();
}

}  // namespace fiber_proximity_ros
