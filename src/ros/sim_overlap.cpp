#include "fiber_proximity/ros/sim_overlap.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/sim/overlaps.hpp"
#include "fiber_proximity/sim/reach.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

/// So many pairs of segments are looked for to tell how many there are.
constexpr std::uint32_t most_counted = 1000;

bool read_is_separate(const YamlField& document) {
  const auto field = document.find("initial_overlap");
  if (!field || field->text() == "refuse") {
    return false;
  }
  if (field->text() != "separate") {
    field->refuse("refuse or separate");
  }
  return true;
}

fiber::OverlapFinder make_finder(const SimWorld& world, const SimEffects& effects) {
  fiber::OverlapFinder::Options options;
  options.same_fiber = has_effect(effects.names, "self_contact");
  options.different_fibers = has_effect(effects.names, "fiber_contact");
  if (has_effect(effects.names, "environment_contact")) {
    options.environment = world.environment;
    options.allowed = world.allowed;
  }
  return fiber::OverlapFinder(options);
}

std::string describe(const std::vector<fiber::Overlap>& overlaps, const SimWorld& world,
                     const fiber::Rods& rods) {
  const fiber::Overlap& deepest = overlaps.front();
  const fiber::Contact& contact = deepest.contact;
  const SimFiber& a = world.fibers[contact.fiber_a];
  std::ostringstream text;
  text.precision(3);
  text << a.place << " begins inside of ";
  double touching = rods.radii[contact.fiber_a];
  if (deepest.is_object) {
    text << "obstacle " << fiber::quote(world.environment->objects()[contact.fiber_b].name)
         << ": segment " << contact.segment_a << " of fibre " << fiber::quote(a.name) << " is ";
  } else {
    const SimFiber& b = world.fibers[contact.fiber_b];
    touching += rods.radii[contact.fiber_b];
    text << (contact.fiber_a == contact.fiber_b ? "itself" : b.place) << ": segment "
         << contact.segment_a << " of fibre " << fiber::quote(a.name) << " and segment "
         << contact.segment_b << " of fibre " << fiber::quote(b.name) << " are ";
  }
  text << 1e3 * deepest.depth() << " mm deep in it, " << 1e3 * fiber::touching_share * touching
       << " mm is the most";
  if (overlaps.size() > 1) {
    text << "; so are " << (overlaps.size() < most_counted ? "" : "at least ")
         << overlaps.size() - 1 << " more pairs";
  }
  return text.str();
}

/// How far nodes are at most from where they were, and edges stretched, for the log.
std::string describe_move(const std::vector<Eigen::Vector3d>& before, const fiber::Rods& rods,
                          std::size_t count) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    farthest = std::max(farthest, (rods.positions[i] - before[i]).norm());
  }
  std::ostringstream text;
  text.precision(3);
  text << "initial_overlap: " << count << " pair(s) of segments began inside of each other; nodes "
       << "were moved by up to " << 1e3 * farthest << " mm, which stretches edges by up to "
       << 100.0 * fiber::largest_strain(rods).strain << " %";
  return text.str();
}

std::vector<bool> held_nodes(const SimEffects& effects, const fiber::Rods& rods) {
  std::vector<bool> is_held(rods.positions.size(), false);
  for (std::uint32_t rod = 0; rod < rods.count() && effects.attachment != nullptr; ++rod) {
    for (const fiber::HeldNode& held : effects.attachment->held_at(rod, 0.0)) {
      is_held[rods.first(rod) + held.node] = true;
    }
  }
  return is_held;
}

}  // namespace

std::string read_initial_overlap(const YamlField& document, const SimWorld& world,
                                 const SimEffects& effects, fiber::Rods& rods) {
  const bool is_separate = read_is_separate(document);
  fiber::OverlapFinder finder = make_finder(world, effects);
  const std::vector<fiber::Overlap> overlaps =
      finder.find(rods, fiber::touching_share, most_counted);
  if (overlaps.empty()) {
    return "";
  }
  if (!is_separate) {
    throw std::invalid_argument(describe(overlaps, world, rods) +
                                "; move them apart, or have `initial_overlap: separate`");
  }
  const std::vector<Eigen::Vector3d> before = rods.positions;
  const std::vector<fiber::Overlap> left =
      fiber::separate_overlaps(rods, finder, held_nodes(effects, rods));
  if (!left.empty()) {
    throw std::invalid_argument(describe(left, world, rods) +
                                ", where `initial_overlap: separate` has moved them: there may be "
                                "no room, or what holds them is in the way");
  }
  return describe_move(before, rods, overlaps.size());
}

}  // namespace fiber_proximity_ros
