// Whether what holds fibres that are joined leaves a place to each joint.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/sim/scene/joints.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/sim/scene/rope_net.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Holds = std::vector<const SimHold*>;

/// The fibres of a scene that joints connect, as ropes between joints and holds.
class JoinedFibers {
 public:
  explicit JoinedFibers(const SimDescription& scene) : rods_(scene.rods) {
    std::int32_t last = -1;
    for (const std::int32_t joint : rods_.joints) {
      last = std::max(last, joint);
    }
    joints_.resize(static_cast<std::size_t>(last + 1), Vector3d::Zero());
    names_.resize(joints_.size());
    for (std::size_t node = 0; node < rods_.joints.size(); ++node) {
      if (rods_.joints[node] >= 0) {
        joints_[static_cast<std::size_t>(rods_.joints[node])] = rods_.positions[node];
      }
    }
    for (const SimJoint& joint : scene.joints) {
      const JointNode& node = joint.joint.nodes.front();
      names_[static_cast<std::size_t>(rods_.joints[rods_.first(node.rod) + node.node])] =
          joint.place;
    }
  }

  bool has_joint(std::uint32_t rod) const {
    return std::any_of(rods_.joints.begin() + rods_.first(rod),
                       rods_.joints.begin() + rods_.end(rod),
                       [](std::int32_t joint) { return joint >= 0; });
  }

  /// The ropes between joints and some holds, stretched by a factor.
  RopeNet net(const Holds& holds, double stretch) const {
    RopeNet net{joints_.size(), {}};
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      std::map<std::uint32_t, std::vector<std::size_t>> ends;  // by node of the rod
      for (std::uint32_t i = rods_.first(rod); i < rods_.end(rod); ++i) {
        if (rods_.joints[i] >= 0) {
          ends[i - rods_.first(rod)].push_back(static_cast<std::size_t>(rods_.joints[i]));
        }
      }
      if (ends.empty()) {
        continue;
      }
      for (std::size_t hold = 0; hold < holds.size(); ++hold) {
        if (holds[hold]->rod == rod) {
          ends[holds[hold]->node].push_back(joints_.size() + hold);
        }
      }
      for (auto end = ends.begin(), before = ends.end(); end != ends.end(); before = end++) {
        if (before != ends.end()) {
          const double length = rest_length_between(rods_, rod, before->first, end->first);
          net.ropes.push_back({before->second.front(), end->second.front(), stretch * length});
        }
        if (end->second.size() > 1) {  // a joint that is held
          net.ropes.push_back({end->second.front(), end->second.back(), 0.0});
        }
      }
    }
    return net;
  }

  /// Joints where they begin, and what is held at a time [m].
  std::vector<Vector3d> ends(const Holds& holds, double time) const {
    std::vector<Vector3d> ends = joints_;
    for (const SimHold* hold : holds) {
      ends.push_back(position_on(*hold, time));
    }
    return ends;
  }

  bool are_torn(const Holds& holds, double time, double stretch) const {
    return !tearing_tensions(net(holds, stretch), ends(holds, time)).empty();
  }

  /// Leaves out what the others do not need to tear joints.
  Holds those_that_tear(Holds holds, double time, double stretch) const {
    for (std::size_t i = holds.size(); i-- > 0;) {
      Holds rest = holds;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      if (are_torn(rest, time, stretch)) {
        holds = rest;
      }
    }
    return holds;
  }

  /// The place in the scene of a joint where the rope ends that pulls most, or else of a hold.
  const std::string& worst_place(const Holds& holds, double time, double stretch) const {
    const RopeNet net = this->net(holds, stretch);
    const std::vector<double> tensions = tearing_tensions(net, ends(holds, time));
    const auto worst = std::max_element(tensions.begin(), tensions.end()) - tensions.begin();
    const RopeNet::Rope& rope = net.ropes[static_cast<std::size_t>(worst)];
    for (const std::size_t end : {rope.from, rope.to}) {
      if (end < names_.size() && !names_[end].empty()) {
        return names_[end];
      }
    }
    return holds.back()->place;
  }

  /// The least by which holds stretch fibres, in parts of their length.
  double min_strain(const Holds& holds, double time, double allowed) const {
    double low = allowed;
    double high = 2.0 * (1.0 + allowed) - 1.0;
    while (are_torn(holds, time, 1.0 + high) && high < 1e9) {
      low = high;
      high *= 2.0;
    }
    while (high - low > 1e-5 * high) {
      const double middle = 0.5 * (low + high);
      (are_torn(holds, time, 1.0 + middle) ? low : high) = middle;
    }
    return low;
  }

 private:
  const Rods& rods_;
  std::vector<Vector3d> joints_;    ///< where they begin [m]
  std::vector<std::string> names_;  ///< their places in the scene; empty: a fibre is closed there
};

/// When what holds reach is to be looked at. Between waypoints holds go straight. How much is
/// missing is convex in time then: it is most at one of these.
///
/// Paths with periods are followed until all begin again together, but no longer than for some
/// rounds of the longest.
std::set<double> waypoint_times(const Holds& holds) {
  constexpr int max_rounds = 16;
  double end = 0.0;
  double longest = 0.0;
  std::vector<double> periods;
  for (const SimHold* hold : holds) {
    const double last = hold->path.back().time;
    end = std::max(end, last);
    if (hold->is_periodic) {
      longest = std::max(longest, last);
      periods.push_back(last);
    }
  }
  int rounds = 1;
  const auto is_whole = [&](double period) {
    const double ratio = rounds * longest / period;
    return std::abs(ratio - std::round(ratio)) < 1e-9;
  };
  while (rounds < max_rounds && !std::all_of(periods.begin(), periods.end(), is_whole)) {
    ++rounds;
  }
  end += rounds * longest;
  std::set<double> times;
  for (const SimHold* hold : holds) {
    const double period = hold->is_periodic ? hold->path.back().time : 0.0;
    double begin = 0.0;
    do {
      for (const SimWaypoint& waypoint : hold->path) {
        times.insert(begin + waypoint.time);
      }
      begin += period;
    } while (period > 0.0 && begin < end);
  }
  return times;
}

std::string names_of(const Holds& holds, const SimDescription& scene, double time) {
  std::string text;
  for (const SimHold* hold : holds) {
    const Vector3d at = position_on(*hold, time);
    text += format(text.empty() ? "" : ", ", "node ", hold->node, " of fibre ",
                   quote(scene.fiber_names[hold->rod]), " at (", at.x(), ", ", at.y(), ", ", at.z(),
                   ")");
  }
  return text;
}

}  // namespace

void require_holds_in_reach(const SimDescription& scene) {
  if (scene.joints.empty()) {
    return;
  }
  const JoinedFibers fibers(scene);
  Holds holds;
  for (const SimHold& hold : scene.holds) {
    if (!hold.frame && fibers.has_joint(hold.rod)) {
      holds.push_back(&hold);
    }
  }
  const double stretch = 1.0 + scene.max_strain;
  const RopeNet net = fibers.net(holds, stretch);
  for (const double time : waypoint_times(holds)) {
    if (!tearing_tensions(net, fibers.ends(holds, time)).empty()) {
      holds = fibers.those_that_tear(holds, time, stretch);
      throw std::invalid_argument(
          format(fibers.worst_place(holds, time, stretch), ": at ", time, " s, what holds ",
                 names_of(holds, scene, time), " stretches the fibres between by ",
                 percent(fibers.min_strain(holds, time, scene.max_strain)),
                 " % at least, more than ", 100.0 * scene.max_strain, " % (max_strain)"));
    }
  }
}

}  // namespace fiber
