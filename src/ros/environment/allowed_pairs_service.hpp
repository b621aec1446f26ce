#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/AllowPairs.h"
#include "src/environment/allowed_contacts.hpp"

namespace fiber_proximity_ros {

/// Keeps which fibres may touch which objects. The pairs are those of the scene at first; the
/// service ~allow_pairs changes them.
class AllowedPairsService {
 public:
  /// @param on_change called when the service has changed the pairs
  /// @throws std::invalid_argument as fiber::AllowedContacts::apply
  AllowedPairsService(ros::NodeHandle private_node, const std::vector<fiber::NamedPair>& allowed,
                      std::function<void()> on_change);

  const std::vector<fiber::NamedPair>& pairs() const { return allowed_.pairs(); }

  /// Whether every fibre may touch an object; of an empty name, whether it may touch all of them.
  bool may_touch_all(const std::string& object) const;

 private:
  bool answer(fiber_proximity::AllowPairs::Request& request,
              fiber_proximity::AllowPairs::Response& response);
  void warn() const;

  std::string node_name_;
  std::function<void()> on_change_;
  fiber::AllowedContacts allowed_;
  ros::ServiceServer server_;  // last: its callback uses all of the above
};

}  // namespace fiber_proximity_ros
