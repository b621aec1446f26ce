#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/options.hpp"

namespace fiber {

/// What makes a hair style. Hairs follow smooth paths; those of a lock are drawn towards the path
/// of the lock, and curl together with it.
struct HairStyle {
  std::uint32_t hair_count = 0;  ///< at scale 1
  std::uint32_t segments = 0;    ///< of every hair
  bool on_head = true;           ///< else a tress that hangs from a disc

  double length = 0.0;            ///< [m] of a path, without the curl around it
  double length_variation = 0.0;  ///< fraction by which hairs are at most shorter

  // The path: where a hair turns to from its root on.
  Eigen::Vector3d pull{0.0, 0.0, -1.0};  ///< gravity, or the wind
  Eigen::Vector3d comb{0.0, 0.0, 0.0};   ///< added near the head; y to either side of a parting
  double gather = 0.0;                   ///< of a tress: pull towards its axis, per m of distance
  double eddies = 0.0;                   ///< added to the pull: how unsteady the wind is
  double stiffness = 0.02;               ///< [m] along the hair in which it turns to the pull
  double coat = 0.0;                     ///< [m] to which layers of hair pile up on the head

  double lock_size = 0.0;  ///< [m] edge of a lock on the scalp
  double clump = 0.0;      ///< part of the way to the lock's path that its hairs go, at the tip

  // The curl around the path.
  double curl_radius = 0.0;     ///< [m]
  double curl_flatness = 0.0;   ///< 0: helix; 1: wave in a plane
  double curl_pitch = 1.0;      ///< [m] of path per turn
  double curl_start = 0.0;      ///< [m] of path in which the curl grows to its radius
  double curl_variation = 0.0;  ///< of the radius, and of the turns, within a lock; fraction
  double wander = 0.0;          ///< [m] by which a hair strays from its lock, at the tip

  double sway = 0.0;  ///< [m] amplitude of the tips over the frames
};

/// Radius of a hair: half of the paper's 0.007 cm [m].
constexpr double hair_radius = 3.5e-5;

/// Frames after which the sway repeats.
constexpr std::uint32_t sway_period = 100;

/// Least level (see Head) of all points but the roots: 0.75 mm to 1.15 mm off the skin.
constexpr double hair_clearance = 0.01;

/// Hairs of this style, all of the same number of segments. Their roots have hair_density, so a
/// smaller scale grows the same hair on a smaller patch around the crown. No hair passes through
/// the Head. Each frame is computed from nothing but the options and its number, and is the same
/// bits everywhere; from one to the next no point moves farther than
/// max_hair_step(style).
/// @throws std::invalid_argument for a scale that needs more scalp than there is
FiberAssembly hair(const HairStyle& style, const SceneOptions& options, std::uint32_t frame);

/// Bound on the motion of a point from frame to frame [m].
double max_hair_step(const HairStyle& style);

}  // namespace fiber
