#include "src/sim/scene/overlap.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/sim/overlaps.hpp"
#include "src/sim/reach.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// So many pairs of segments are looked for to tell how many there are.
constexpr std::uint32_t most_counted = 1000;

OverlapFinder make_finder(const SimDescription& scene) {
  OverlapFinder::Options options;
  options.same_fiber = scene.has_effect("self_contact");
  options.different_fibers = scene.has_effect("fiber_contact");
  if (scene.has_effect("environment_contact")) {
    options.environment = scene.environment;
    options.allowed = scene.allowed;
  }
  return OverlapFinder(options);
}

std::string describe(const std::vector<Overlap>& overlaps, const SimDescription& scene,
                     const Rods& rods) {
  const Overlap& deepest = overlaps.front();
  const Contact& contact = deepest.contact;
  const SimFiber& a = scene.fibers[contact.fiber_a];
  std::ostringstream text;
  text.precision(3);
  text << a.place << " begins inside of ";
  double touching = rods.radii[contact.fiber_a];
  if (deepest.is_object) {
    text << "obstacle " << quote(scene.environment->objects()[contact.fiber_b].name) << ": segment "
         << contact.segment_a << " of fibre " << quote(a.name) << " is ";
  } else {
    const SimFiber& b = scene.fibers[contact.fiber_b];
    touching += rods.radii[contact.fiber_b];
    text << (contact.fiber_a == contact.fiber_b ? "itself" : b.place) << ": segment "
         << contact.segment_a << " of fibre " << quote(a.name) << " and segment "
         << contact.segment_b << " of fibre " << quote(b.name) << " are ";
  }
  text << 1e3 * deepest.depth() << " mm deep in it, " << 1e3 * touching_share * touching
       << " mm is the most";
  if (overlaps.size() > 1) {
    text << "; so are " << (overlaps.size() < most_counted ? "" : "at least ")
         << overlaps.size() - 1 << " more pairs";
  }
  return text.str();
}

/// How far nodes are at most from where they were, and edges stretched, for the log.
std::string describe_move(const std::vector<Eigen::Vector3d>& before, const Rods& rods,
                          std::size_t count) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    farthest = std::max(farthest, (rods.positions[i] - before[i]).norm());
  }
  std::ostringstream text;
  text.precision(3);
  text << "initial_overlap: " << count << " pair(s) of segments began inside of each other; nodes "
       << "were moved by up to " << 1e3 * farthest << " mm, which stretches edges by up to "
       << 100.0 * largest_strain(rods).strain << " %";
  return text.str();
}

std::vector<bool> held_nodes(const Attachment* attachment, const Rods& rods) {
  std::vector<bool> is_held(rods.positions.size(), false);
  for (std::uint32_t rod = 0; rod < rods.count() && attachment != nullptr; ++rod) {
    for (const HeldNode& held : attachment->held_at(rod, 0.0)) {
      is_held[rods.first(rod) + held.node] = true;
    }
  }
  return is_held;
}

}  // namespace

std::string settle_overlaps(const SimDescription& scene, const Attachment* attachment, Rods& rods) {
  OverlapFinder finder = make_finder(scene);
  const std::vector<Overlap> overlaps = finder.find(rods, touching_share, most_counted);
  if (overlaps.empty()) {
    return "";
  }
  if (!scene.separates_overlaps) {
    throw std::invalid_argument(describe(overlaps, scene, rods) +
                                "; move them apart, or have `initial_overlap: separate`");
  }
  const std::vector<Eigen::Vector3d> before = rods.positions;
  const std::vector<Overlap> left = separate_overlaps(rods, finder, held_nodes(attachment, rods));
  if (!left.empty()) {
    throw std::invalid_argument(describe(left, scene, rods) +
                                ", where `initial_overlap: separate` has moved them: there may be "
                                "no room, or what holds them is in the way");
  }
  return describe_move(before, rods, overlaps.size());
}

}  // namespace fiber
