#pragma once

#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/joints.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber::test {

/// What a scene may call for beside rods alike all along that fall on a table: tests that are about
/// all scenes go through these.
enum class Extra { NONE, LOADS, MOMENT, SECTIONS, BALL, WELD, CLOSED, LIFT, STRIPS };

inline std::string name_of(Extra extra) {
  const char* const names[] = {"plain", "loads",  "moment", "sections", "ball",
                               "weld",  "closed", "lift",   "strips"};
  return names[static_cast<std::size_t>(extra)];
}

inline std::ostream& operator<<(std::ostream& out, Extra extra) { return out << name_of(extra); }

/// Makes an edge rigid, half as thick again and heavier than the rest.
inline void add_plug(Rods& rods, std::uint32_t rod, std::uint32_t edge) {
  const double radius = 1.5 * rods.radii[rod];
  RodSectionPart plug{{arc_to(rods, rod, edge), arc_to(rods, rod, edge + 1)}, rubber(radius)};
  plug.radius = radius;
  plug.is_rigid = true;
  rods.set_sections(rod, {plug});
}

/// Makes rods flat: four times as stiff to one side as across it, each to another one.
/// @returns what they resist by beyond round rods, twist included
inline Effects make_strips(Rods& rods) {
  for (RodSection& section : rods.sections) {
    section.bending_ratio = 4.0;
  }
  Effects all;
  all.push_back(std::make_unique<Twist>(rods));
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const double angle = 0.4 + 0.9 * rod;
    const Eigen::Vector3d& tangent = rods.start_tangents[rods.first(rod)];
    const Eigen::Vector3d& director = rods.directors[rods.first(rod)];
    rods.set_stiff_side(rod,
                        std::cos(angle) * director + std::sin(angle) * tangent.cross(director));
  }
  all.push_back(std::make_unique<AnisotropicBend>());
  all.push_back(std::make_unique<AnisotropicDamping>(std::make_shared<Damping>(0.01)));
  return all;
}

/// A ring of so many edges, level, at a height.
inline std::vector<Eigen::Vector3d> ring(double radius, double height, int edges) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= edges; ++i) {
    const double angle = 2.0 * M_PI * (i % edges) / edges;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  }
  return points;
}

/// Some rods, of which the last three are straight, with an extra.
class ExtraScene {
 public:
  /// @param height above all rods, for what the extra adds [m]
  ExtraScene(Rods rods, Extra extra, double height) : extra_(extra), bare_(std::move(rods)) {
    const double radius = bare_.radii[0];
    if (extra == Extra::SECTIONS) {
      bare_.set_sections(last() - 1, {{{0.05, 0.1}, rubber(0.8 * radius)}});
      add_plug(bare_, last(), bare_.node_count(last()) / 2);
    }
    for (int arm = 0; (extra == Extra::BALL || extra == Extra::WELD) && arm < 3; ++arm) {
      const double angle = 2.0 * M_PI * arm / 3.0 + 0.2;
      const Eigen::Vector3d middle(0.0, 0.0, height);
      const Eigen::Vector3d end =
          middle + (0.06 + 0.02 * arm) * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.1);
      bare_.add(straight(middle, end, 6 + arm), radius, rubber(radius));
    }
    if (extra == Extra::CLOSED) {
      bare_.add(ring(0.06, height, 32), radius, rubber(radius));
    }
    rods_ = bare_;
    effects_of(rods_);
    joints_of(rods_);
  }

  Extra extra() const { return extra_; }

  /// As they begin.
  const Rods& rods() const { return rods_; }

  /// Null for none.
  std::unique_ptr<Joints> joints() const {
    Rods rods = bare_;
    return joints_of(rods);
  }

  void add_effects(Effects& effects) const {
    Rods rods = bare_;
    for (auto& effect : effects_of(rods)) {
      effects.push_back(std::move(effect));
    }
  }

  /// Of the table [m/s].
  Eigen::Vector3d table_velocity() const {
    return extra_ == Extra::LIFT ? Eigen::Vector3d(0.02, -0.01, 0.05) : Eigen::Vector3d::Zero();
  }

  /// Where the table is at a time [s].
  Eigen::Isometry3d table_at(double time) const { return at_place(time * table_velocity()); }

  /// Contacts of rods with each other and with the table, the half-space below where it is.
  /// @param begin where their time is 0 [s]
  std::unique_ptr<Contacts> contacts(double stiffness, double friction, double begin = 0.0) const {
    std::vector<std::unique_ptr<ContactSource>> sources;
    FiberContact::Options fiber;
    fiber.stiffness = stiffness;
    sources.push_back(std::make_unique<FiberContact>(fiber));
    EnvironmentContact::Options obstacle;
    obstacle.stiffness = stiffness;
    std::shared_ptr<ObstacleMotions> motions;
    if (extra_ == Extra::LIFT) {
      motions = std::make_shared<ObstacleMotions>(
          std::vector<MovingObstacle>{
              moving("table", HalfSpaceShape{},
                     [this, begin](double time) { return table_at(begin + time); })},
          0);
      sources.push_back(std::make_unique<MovingObstacleContact>(motions, obstacle));
    } else {
      sources.push_back(
          std::make_unique<EnvironmentContact>(environment_of(HalfSpaceShape{}), obstacle));
    }
    return std::make_unique<Contacts>(
        std::move(sources), std::make_unique<Friction>(Friction::Options{friction, 1e-3}), motions);
  }

 private:
  std::uint32_t last() const { return bare_.count() - 1; }

  std::unique_ptr<Joints> joints_of(Rods& rods) const {
    std::unique_ptr<Joints> joints;
    if (extra_ == Extra::CLOSED) {
      joints = std::make_unique<Joints>(Joints::Options{});
      joints->close(rods, rods.count() - 1);
    } else if (extra_ == Extra::BALL || extra_ == Extra::WELD) {
      joints = std::make_unique<Joints>(Joints::Options{});
      const std::uint32_t first = rods.count() - 3;
      joints->add(rods, {extra_ == Extra::BALL ? Joints::Kind::BALL : Joints::Kind::WELD,
                         {{first, 0}, {first + 1, 0}, {first + 2, 0}}});
    }
    return joints;
  }

  /// What they need of rods is added to these: masses of loads, frames and sides of strips.
  Effects effects_of(Rods& rods) const {
    if (extra_ == Extra::STRIPS) {
      return make_strips(rods);
    }
    Effects all;
    if (auto loads = loads_of(rods)) {
      all.push_back(std::move(loads));
    }
    return all;
  }

  /// Adds their masses as well; null for none.
  std::unique_ptr<Loads> loads_of(Rods& rods) const {
    std::unique_ptr<Loads> loads;
    if (extra_ != Extra::LOADS && extra_ != Extra::MOMENT) {
      return loads;
    }
    loads = std::make_unique<Loads>();
    Loads::Load load;
    load.rod = last();
    if (extra_ == Extra::MOMENT) {
      load.moment = TimeTable<Eigen::Vector3d>(Eigen::Vector3d(1e-3, 2e-3, 0.0));
      loads->add(rods, load);
      return loads;
    }
    load.mass = 0.005;
    loads->add(rods, load);
    Loads::Load pull;
    pull.rod = last() - 1;
    pull.node = rods.node_count(pull.rod) - 1;
    pull.force = TimeTable<Eigen::Vector3d>(Eigen::Vector3d(0.02, 0.0, 0.01));
    loads->add(rods, pull);
    Loads::Load wind;
    wind.rod = last() - 2;
    wind.part = RodPart{0.05, 0.15};
    wind.force = TimeTable<Eigen::Vector3d>(Eigen::Vector3d(0.0, 0.1, -0.2));
    loads->add(rods, wind);
    return loads;
  }

  Extra extra_;
  Rods bare_;  // without the masses of loads, and not joined
  Rods rods_;
};

}  // namespace fiber::test
