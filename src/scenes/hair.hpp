#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

/// The parameters of a hair style. Hairs follow smooth paths; those of a lock are drawn towards the
/// path of the lock, and curl together with it.
struct HairStyle {
  std::uint32_t hair_count = 0;  ///< at scale 1
  std::uint32_t segments = 0;    ///< of every hair
  bool on_head = true;           ///< else a tress that hangs from a disc

  /// Where a hair turns to from its root on.
  struct Path {
    double length = 0.0;            ///< [m] without the curl around it
    double length_variation = 0.0;  ///< fraction by which hairs are at most shorter
    Eigen::Vector3d pull;           ///< gravity, or the wind
    Eigen::Vector3d comb;           ///< added near the head; y to either side of a parting
    double gather = 0.0;            ///< of a tress: pull towards its axis, per m of distance
    double eddies = 0.0;            ///< added to the pull: how unsteady the wind is
    double stiffness = 0.0;         ///< [m] along the hair in which it turns to the pull
    double coat = 0.0;              ///< [m] to which layers of hair pile up on the head
  } path;

  struct Locks {
    double size = 0.0;    ///< [m] edge of a lock on the scalp
    double clump = 0.0;   ///< part of the way to the lock's path that its hairs go, at the tip
    double wander = 0.0;  ///< [m] by which a hair strays from its lock, at the tip
  } locks;

  /// Around the path.
  struct Curl {
    double radius = 0.0;     ///< [m]
    double flatness = 0.0;   ///< 0: helix; 1: wave in a plane
    double pitch = 0.0;      ///< [m] of path per turn
    double start = 0.0;      ///< [m] of path in which the curl grows to its radius
    double variation = 0.0;  ///< of the radius, and of the turns, within a lock; fraction
  } curl;

  double sway = 0.0;  ///< [m] amplitude of the tips over the frames
};

// The paper's hair (Fig. 1), with its numbers of hairs and segments, its density and its diameter.
// Shape, length and locks are our own: the paper shows a picture of each and says no more. Hairs
// lie beside each other at distances around their diameter and, as interpolated styles do, partly
// in each other. Contacts are per segment, at scale 1, seed 1, frame 0 and margin 0, neighbours in
// a hair left out; a smaller scale has fewer, because fewer hairs fall on the same place.

extern const HairStyle tress_a;   ///< 2 500 × 98: a wavy strand; 0.75 contacts
extern const HairStyle tress_b;   ///< 500 × 2 000: long curls; 0.12 contacts
extern const HairStyle tress_c;   ///< 1 000 × 2 000: tress B with twice the hairs; 0.20 contacts
extern const HairStyle charming;  ///< 49 000 × 49: waves to the shoulders; 1.75 contacts
extern const HairStyle curly;     ///< 47 000 × 100: tight helices; 1.43 contacts
extern const HairStyle windy;     ///< 60 000 × 50: blown back and to one side; 0.50 contacts
extern const HairStyle longish;   ///< 39 000 × 54: long and nearly straight; 0.85 contacts

/// Radius of a hair: half of the paper's 0.007 cm [m].
constexpr double hair_radius = 3.5e-5;

/// Frames after which the sway repeats.
constexpr std::uint32_t sway_period = 100;

/// Least level (see Head) of all points but the roots: 0.75 mm to 1.15 mm off the skin.
constexpr double hair_clearance = 0.01;

/// Hairs of this style, all of the same number of segments. Their roots have hair_density, so a
/// smaller scale grows the same hair on a smaller patch around the crown. No hair passes through
/// the Head. Each frame is computed from nothing but the options and its number, and is the same
/// bits everywhere.
/// @throws std::invalid_argument for a scale that needs more scalp than there is
FiberAssembly hair(const HairStyle& style, const SceneOptions& options, std::uint32_t frame);

}  // namespace fiber
