#include "src/scenes/hair.hpp"

#include <limits>
#include <utility>
#include <vector>

#include "src/scenes/scalp.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double comb_reach = 0.4;  // level (see Head) off the skin

/// The path and size that all hairs of a lock share.
struct LockShape {
  std::vector<Vector3d> path;
  std::vector<Vector3d> side;  // unit, perpendicular to the path
  std::vector<Vector3d> rise;  // unit, perpendicular to both
  double layer;                // 0 on the skin to 1 at the top of the coat
  double length;               // [m]
  double curl_phase;           // [turns]
  double curl_turns;           // signed
  Vector3d eddies;             // where the lock is in the wind [m]
  Vector3d sway;               // unit
  double sway_phase;           // [turns]
};

/// The sum of two waves of random phase along a hair, for its own small way.
struct Wander {
  Vector3d direction_a, direction_b;  // unit
  double phase_a, phase_b;            // [turns]
  double turns_a, turns_b;

  explicit Wander(Random& random)
      : direction_a(random.direction()),
        direction_b(random.direction()),
        phase_a(random.uniform(0.0, 1.0)),
        phase_b(random.uniform(0.0, 1.0)),
        turns_a(random.uniform(0.5, 1.5)),
        turns_b(random.uniform(1.5, 4.0)) {}

  Vector3d at(double t) const {
    return 0.7 * sine_of_turns(phase_a + turns_a * t) * direction_a +
           0.3 * sine_of_turns(phase_b + turns_b * t) * direction_b;
  }
};

class HairGrower {
 public:
  HairGrower(const HairStyle& style, std::uint64_t seed, double time, std::uint32_t hairs)
      : style_(style), random_(seed), time_(time) {
    roots_ = style.on_head ? scalp_roots(hairs, random_) : disc_roots(hairs, random_);
    points_.reserve(std::size_t{hairs} * (style.segments + 1));
  }

  std::vector<Vector3d> grow() {
    for (const Lock& lock : order_in_locks(roots_, style_.locks.size)) {
      shape_lock(lock);
      for (std::uint32_t root = lock.begin; root < lock.end; ++root) {
        append_hair(roots_[root]);
      }
    }
    return std::move(points_);
  }

 private:
  /// The root in the middle of a lock.
  Root middle(const Lock& lock) const {
    Root root{Vector3d::Zero(), Vector3d::Zero(), Eigen::Vector2d::Zero(), 0.0};
    for (std::uint32_t i = lock.begin; i < lock.end; ++i) {
      root.point += roots_[i].point;
      root.polar += roots_[i].polar;
    }
    const double count = lock.end - lock.begin;
    root.point /= count;
    root.polar /= count;
    root.normal = roots_[lock.begin].normal;
    if (style_.on_head) {
      root.point = Head::lifted(root.point, 1.0);
      root.normal = Head::normal(root.point);
    }
    return root;
  }

  void shape_lock(const Lock& lock) {
    const Root root = middle(lock);
    // Hair from near the crown lies over the hair that grows farther down.
    const double depth = 1.0 - smooth_step(root.polar / 0.2);
    lock_.layer = 0.5 * depth + random_.uniform(0.0, 0.5);
    lock_.length = style_.path.length * (1.0 - random_.uniform(0.0, style_.path.length_variation));
    lock_.curl_phase = random_.uniform(0.0, 1.0);
    const double handedness = random_.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    lock_.curl_turns =
        handedness * style_.path.length / style_.curl.pitch * random_.uniform(0.9, 1.1);
    lock_.eddies = root.point + random_.point_in_cube(-0.01, 0.01);
    lock_.sway = random_.direction();
    lock_.sway_phase = random_.uniform(0.0, 0.2) + 2.0 * root.point.x() + 3.0 * root.point.y();
    comb(root, lock_.layer, lock_.length, lock_.path);
    frame_path();
  }

  /// Carries a frame along the lock's path with as little rotation as possible.
  void frame_path() {
    lock_.side.clear();
    lock_.rise.clear();
    Vector3d side = Vector3d::UnitX();
    for (std::size_t i = 0; i < lock_.path.size(); ++i) {
      const std::size_t next = i + 1 < lock_.path.size() ? i + 1 : i;
      const Vector3d tangent = unit(lock_.path[next] - lock_.path[next - 1]);
      if (i == 0 && std::abs(tangent.x()) > 0.7) {
        side = Vector3d::UnitY();
      }
      side = perpendicular_unit(side, tangent);
      lock_.side.push_back(side);
      lock_.rise.push_back(tangent.cross(side));
    }
  }

  /// Where a hair at this point turns to.
  Vector3d wanted_direction(const Vector3d& point) const {
    Vector3d wanted = style_.path.pull;
    if (style_.on_head) {
      // A comb reaches what lies on the head, not what hangs down.
      const double weight = 1.0 - smooth_step((Head::level(point) - 1.0) / comb_reach);
      const double parting = point.y() / std::sqrt(point.y() * point.y() + 1e-4);
      wanted += weight * Vector3d(style_.path.comb.x(), parting * style_.path.comb.y(),
                                  style_.path.comb.z());
    } else {
      wanted -= style_.path.gather * Vector3d(point.x(), point.y(), 0.0);
    }
    if (style_.path.eddies > 0.0) {
      wanted += style_.path.eddies * eddy(point + lock_.eddies);
    }
    return unit(wanted);
  }

  /// A smooth field of winds of about a decimetre.
  static Vector3d eddy(const Vector3d& p) {
    return {sine_of_turns(5.0 * p.y() + 3.0 * p.z() + 0.1) + sine_of_turns(9.0 * p.x()),
            sine_of_turns(4.0 * p.z() + 5.0 * p.x() + 0.4) + sine_of_turns(8.0 * p.y() + 0.7),
            sine_of_turns(6.0 * p.x() + 4.0 * p.y() + 0.2) + sine_of_turns(7.0 * p.z() + 0.3)};
  }

  /// The path of a hair from its root on, before it curls.
  void comb(const Root& root, double layer, double length, std::vector<Vector3d>& path) const {
    const double step = length / style_.segments;
    const double pile = (style_.curl.radius + layer * style_.path.coat) / Head::semi_axes[0];
    path.assign(1, root.point);
    Vector3d direction = unit(root.normal + 0.5 * wanted_direction(root.point));
    for (std::uint32_t i = 1; i <= style_.segments; ++i) {
      const Vector3d& point = path.back();
      const Vector3d turn = wanted_direction(point) - direction;
      direction = unit(direction + step / (step + style_.path.stiffness) * turn);
      Vector3d next = point + step * direction;
      if (style_.on_head) {
        // Lie on the layers below, and let the hair turn along them.
        const double level = 1.0 + hair_clearance + smooth_step(i * step / 0.05) * pile;
        direction = unit(Head::lifted(next, level) - point);
        next = point + step * direction;
      }
      path.push_back(next);
    }
  }

  void append_hair(const Root& root) {
    const double variation = style_.curl.variation;
    const double layer = lock_.layer + random_.uniform(-0.1, 0.1);
    const double length = lock_.length * (1.0 - random_.uniform(0.0, style_.path.length_variation));
    const double radius = style_.curl.radius * (1.0 + random_.uniform(-variation, variation));
    const double turns = lock_.curl_turns * (1.0 + 0.2 * random_.uniform(-variation, variation));
    const double phase = lock_.curl_phase + 0.2 * random_.uniform(-variation, variation);
    const Wander wander(random_);
    comb(root, layer, length, path_);
    points_.push_back(root.point);
    for (std::uint32_t i = 1; i <= style_.segments; ++i) {
      const double t = static_cast<double>(i) / style_.segments;
      const double curl = radius * smooth_step(length * t / style_.curl.start);
      const double turn = phase + turns * t;
      const Vector3d point =
          path_[i] + style_.locks.clump * smooth_step(t) * (lock_.path[i] - path_[i]) +
          curl * (cosine_of_turns(turn) * lock_.side[i] +
                  (1.0 - style_.curl.flatness) * sine_of_turns(turn) * lock_.rise[i]) +
          style_.locks.wander * t * wander.at(t) + sway_at(t);
      points_.push_back(style_.on_head ? Head::lifted(point, 1.0 + hair_clearance) : point);
    }
  }

  Vector3d sway_at(double t) const {
    return style_.sway * t * t * sine_of_turns(time_ + lock_.sway_phase - 0.3 * t) * lock_.sway;
  }

  const HairStyle& style_;
  Random random_;
  const double time_;  // [periods of the sway]
  std::vector<Root> roots_;
  LockShape lock_;
  std::vector<Vector3d> path_;  // of the hair that grows
  std::vector<Vector3d> points_;
};

using Path = HairStyle::Path;
using Locks = HairStyle::Locks;
using Curl = HairStyle::Curl;

const Vector3d down(0.0, 0.0, -1.0);
const Vector3d nowhere(0.0, 0.0, 0.0);
const Vector3d to_shoulders(-0.9, 0.8, 0.0);

HairStyle with_hairs(HairStyle style, std::uint32_t hair_count) {
  style.hair_count = hair_count;
  return style;
}

}  // namespace

// Each: hairs, segments, on a head or not, then
//   Path:  length, its variation, pull, comb, gather, eddies, stiffness, coat
//   Locks: size, clump, wander
//   Curl:  radius, flatness, pitch, start, variation
// and the sway at last; units in hair.hpp.
const HairStyle tress_a{2'500,
                        98,
                        false,
                        Path{0.25, 0.04, down, nowhere, 8.0, 0.0, 0.02, 0.0},
                        Locks{0.006, 0.5, 0.004},
                        Curl{0.006, 0.7, 0.06, 0.08, 0.15},
                        0.01};
const HairStyle tress_b{500,
                        2'000,
                        false,
                        Path{0.36, 0.03, down, nowhere, 15.0, 0.0, 0.02, 0.0},
                        Locks{0.005, 0.6, 0.003},
                        Curl{0.009, 0.0, 0.036, 0.1, 0.1},
                        0.01};
const HairStyle tress_c = with_hairs(tress_b, 1'000);
const HairStyle charming{49'000,
                         49,
                         true,
                         Path{0.30, 0.08, down, to_shoulders, 0.0, 0.0, 0.02, 0.025},
                         Locks{0.006, 0.35, 0.004},
                         Curl{0.005, 0.7, 0.07, 0.12, 0.15},
                         0.01};
const HairStyle curly{47'000,
                      100,
                      true,
                      Path{0.16, 0.1, down, {-0.3, 0.5, 0.3}, 0.0, 0.0, 0.03, 0.03},
                      Locks{0.005, 0.4, 0.003},
                      Curl{0.0045, 0.0, 0.016, 0.03, 0.15},
                      0.006};
const HairStyle windy{60'000,
                      50,
                      true,
                      Path{0.25, 0.12, {-1.0, -0.7, 0.05}, nowhere, 0.0, 0.25, 0.03, 0.02},
                      Locks{0.006, 0.5, 0.01},
                      Curl{0.003, 0.8, 0.09, 0.1, 0.2},
                      0.02};
const HairStyle longish{39'000,
                        54,
                        true,
                        Path{0.45, 0.04, down, to_shoulders, 0.0, 0.0, 0.02, 0.012},
                        Locks{0.006, 0.4, 0.004},
                        Curl{0.002, 0.8, 0.2, 0.2, 0.2},
                        0.01};

FiberAssembly hair(const HairStyle& style, const SceneOptions& options, std::uint32_t frame) {
  const std::uint32_t max_hairs =
      style.on_head ? Head::max_hairs : std::numeric_limits<std::uint32_t>::max();
  const std::uint32_t points_per_hair = style.segments + 1;
  const std::uint32_t hairs =
      scaled_fiber_count(options, style.hair_count, points_per_hair, max_hairs);
  const double time = static_cast<double>(frame % sway_period) / sway_period;
  return equal_fibers(HairGrower(style, options.seed, time, hairs).grow(), points_per_hair,
                      hair_radius);
}

}  // namespace fiber
