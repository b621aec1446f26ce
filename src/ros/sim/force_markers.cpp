#include "src/ros/sim/force_markers.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/draw_legend.hpp"
#include "src/ros/outputs/marker_scale.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

enum Namespace { TENSIONS, CONTACTS, HOLDS, LEGEND };

constexpr std::size_t most_arrows = 200;  // rviz takes long for more; the largest
constexpr double longest_arrow = 0.25;    // of the scene
constexpr double fading = 0.97;           // of a scale, from drawing to drawing

struct Arrow {
  Vector3d at;
  Vector3d force;
  Namespace kind;
};

/// The next of 1, 2, 5, 10, … that is not below.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power) {
      return step * power;
    }
  }
  return 10.0 * power;
}

/// What is drawn as full, for a largest value now and what it was before.
double full_scale(double largest, double before) {
  constexpr double least = 1e-9;
  return std::max({largest, fading * before, least});
}

Rgb tension_color(double part) {
  return mix(palette::unloaded, part < 0.0 ? palette::pressed : palette::pulled,
             std::min(1.0, std::abs(part)));
}

std::string newton(double force) {
  std::ostringstream text;
  text << force << " N";
  return text.str();
}

std::vector<Arrow> arrows_of(const fiber::RodForces& forces) {
  std::vector<Arrow> arrows;
  for (const fiber::RodForces::ContactForce& contact : forces.contacts) {
    arrows.push_back({contact.point, contact.normal_force + contact.friction_force, CONTACTS});
  }
  for (const fiber::RodForces::HoldForce& hold : forces.holds) {
    arrows.push_back({hold.point, hold.force, HOLDS});
  }
  const auto is_larger = [](const Arrow& a, const Arrow& b) {
    return a.force.squaredNorm() > b.force.squaredNorm();
  };
  std::stable_sort(arrows.begin(), arrows.end(), is_larger);
  arrows.resize(std::min(arrows.size(), most_arrows));
  return arrows;
}

using Canvas = ForceMarkers::Canvas;

/// @param full [N] what full red or blue is
void draw_tensions(const fiber::Rods& rods, const std::vector<double>& tensions, double full,
                   Canvas& canvas) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    Marker& marker = canvas.add(TENSIONS, Marker::LINE_LIST);
    marker.scale.x = 2.2 * rods.radii[rod];
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      marker.points.push_back(to_message(rods.positions[i]));
      marker.points.push_back(to_message(rods.positions[i + 1]));
      marker.colors.insert(marker.colors.end(), 2, color(tension_color(tensions[i] / full)));
    }
  }
}

/// @param full [N] of the longest arrow
void draw_arrows(const std::vector<Arrow>& arrows, double full, const MarkerScale& scale,
                 Canvas& canvas) {
  const double thickness = std::max(0.5 * scale.thickest, 0.004 * scale.extent);
  for (const Arrow& arrow : arrows) {
    const Vector3d way = longest_arrow * scale.extent / full * arrow.force;
    if (way.norm() < 0.5 * thickness) {
      continue;  // it would be a dot
    }
    Marker& marker = canvas.add(arrow.kind, Marker::ARROW);
    marker.scale.x = thickness;
    marker.scale.y = 2.5 * thickness;
    marker.scale.z = std::min(4.0 * thickness, 0.5 * way.norm());
    marker.color = color(arrow.kind == HOLDS ? palette::hold_force : palette::contact_force);
    marker.points = {to_message(arrow.at), to_message(arrow.at + way)};
  }
}

}  // namespace

void ForceMarkers::draw(const fiber::SimScene& scene, const fiber::RodForces& forces,
                        const std_msgs::Header& header, visualization_msgs::MarkerArray& markers) {
  static const Canvas::Names namespaces{"tensions", "contacts", "holds", "legend"};
  const fiber::Rods& rods = scene.stepper->rods();
  const MarkerScale scale(fiber::FiberAssembly(rods.positions, rods.offsets, rods.radii),
                          header.frame_id);
  double tension = 0.0;
  for (const double each : forces.tensions) {
    tension = std::max(tension, std::abs(each));
  }
  const std::vector<Arrow> arrows = arrows_of(forces);
  most_tension_ = full_scale(tension, most_tension_);
  most_force_ = full_scale(arrows.empty() ? 0.0 : arrows.front().force.norm(), most_force_);
  const double full_tension = round_up(most_tension_);
  const double full_force = round_up(most_force_);
  Canvas canvas(header, namespaces, markers);
  draw_tensions(rods, forces.tensions, full_tension, canvas);
  draw_arrows(arrows, full_force, scale, canvas);
  draw_legend(
      {{palette::pulled, "red: tension, up to " + newton(full_tension)},
       {palette::pressed, "blue: pressure, up to " + newton(full_tension)},
       {palette::contact_force,
        "yellow: contacts; an arrow of full length is " + newton(full_force)},
       {palette::hold_force, "green: holds; an arrow of full length is " + newton(full_force)}},
      scale, LEGEND, canvas);
  canvas.finish(drawn_);
}

}  // namespace fiber_proximity_ros
