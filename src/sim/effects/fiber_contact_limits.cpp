// How far rods may go so that they do not pass through each other, and which may meet on their
// ways.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fiber_proximity/sim/contact_limits.hpp"
#include "fiber_proximity/sim/effects/fiber_contact.hpp"

namespace fiber {

using Eigen::Vector3d;

/// Shortens displacements that bring the edges of a candidate through each other.
/// @param is_fixed in the middle of where they are now; else where they want to meet
/// @returns whether it had to
bool FiberContact::keep_apart(const Rods& rods, std::size_t candidate, bool is_fixed,
                              std::vector<Vector3d>& displacements) const {
  const std::uint32_t a = candidates_[candidate].edge_a;
  const std::uint32_t b = candidates_[candidate].edge_b;
  const Vector3d& normal = partings_[candidate].normal;
  const std::array<double, 2> of_a{normal.dot(rods.positions[a]),
                                   normal.dot(rods.positions[a + 1])};
  const std::array<double, 2> of_b{normal.dot(rods.positions[b]),
                                   normal.dot(rods.positions[b + 1])};
  const double next_a =
      std::max(of_a[0] + normal.dot(displacements[a]), of_a[1] + normal.dot(displacements[a + 1]));
  const double next_b =
      std::min(of_b[0] + normal.dot(displacements[b]), of_b[1] + normal.dot(displacements[b + 1]));
  const double room = partings_[candidate].room;
  constexpr double rounding = 1e-9;
  if (next_b - next_a >= (1.0 - rounding) * room) {
    return false;
  }
  const double end_a = std::max(of_a[0], of_a[1]);
  const double end_b = std::min(of_b[0], of_b[1]);
  double plane = 0.5 * (end_a + end_b);
  if (!is_fixed && end_b - end_a > room) {
    plane = std::clamp(0.5 * (next_a + next_b), end_a + 0.5 * room, end_b - 0.5 * room);
  }
  bool is_shorter = false;
  for (std::uint32_t end = 0; end < 2; ++end) {
    is_shorter |= limit_approach(normal, plane - of_a[end] - 0.5 * room, displacements[a + end]);
    is_shorter |= limit_approach(-normal, of_b[end] - plane - 0.5 * room, displacements[b + end]);
  }
  return is_shorter;
}

/// Whether all that displacements may bring together is a candidate. It is enough that nodes do not
/// get far beside a drift. That is what all share that go in whole; who then goes a share of
/// something else does so beside the same drift, which not all may share with.
bool FiberContact::is_known(const Rods& rods, const std::vector<Vector3d>& displacements, Way way) {
  constexpr double rounding = 1.0 + 1e-9;
  const auto is_near = [&](const Vector3d& drift) {
    return farthest_move(fibers_.points(), rods.positions, displacements, drift) <=
           0.5 * rounding * reach_;
  };
  if (way == Way::SHARES) {
    return is_near(drift_);
  }
  for (const Vector3d& drift :
       {mean_move(fibers_.points(), rods.positions, displacements), Vector3d(Vector3d::Zero())}) {
    if (is_near(drift)) {
      drift_ = drift;
      return true;
    }
  }
  return false;
}

/// How far candidates that are looked for where the step began must be looked for, so that these
/// displacements are known then [m].
double FiberContact::needed_reach(const Rods& rods, const std::vector<Vector3d>& displacements,
                                  Way way) const {
  constexpr double rounding = 1.0 + 1e-9;
  const bool is_whole = way == Way::WHOLE;
  const Vector3d drift = is_whole ? mean_move(beginning_, rods.positions, displacements) : drift_;
  double farthest = farthest_move(beginning_, rods.positions, displacements, drift);
  if (!is_whole) {
    const std::vector<Vector3d> none(displacements.size(), Vector3d::Zero());
    farthest = std::max(farthest, farthest_move(beginning_, rods.positions, none, drift));
  }
  return 2.0 * rounding * farthest;
}

/// Looks for candidates as far as these displacements lead, if that is not too far.
/// @returns whether it is not
bool FiberContact::look_further(const Rods& rods, const std::vector<Vector3d>& displacements,
                                Way way) {
  const double longest_reach = 2.0 * longest_move_;
  if (reach_ < longest_reach || beginning_ != fibers_.points()) {
    const std::vector<Vector3d> none(displacements.size(), Vector3d::Zero());
    drift_ -= mean_move(fibers_.points(), beginning_, none);
    const double needed = needed_reach(rods, displacements, way);
    reach_ = std::max(reach_, std::min(needed, longest_reach));
    find_candidates(rods);
    measure_at(beginning_);
    part_candidates(rods);
    measure(rods);
  }
  return is_known(rods, displacements, way);
}

/// Shortens displacements to what candidates are known for.
void FiberContact::limit_to_known(const Rods& rods, std::vector<Vector3d>& displacements, Way way) {
  const Vector3d drift = way == Way::WHOLE ? Vector3d(Vector3d::Zero()) : drift_;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    const Vector3d moved = rods.positions[i] - fibers_.points()[i] - drift;
    limit_length(0.5 * reach_ - moved.norm(), displacements[i]);
  }
  if (!is_known(rods, displacements, way)) {
    // Far from where they began already: they stay where they are.
    std::fill(displacements.begin(), displacements.end(), Vector3d::Zero());
  }
}

void FiberContact::limit(const Rods& rods, std::vector<Vector3d>& displacements, Way way,
                         int round) {
  bool has_shortened = false;
  do {
    if (!is_known(rods, displacements, way) && !look_further(rods, displacements, way)) {
      limit_to_known(rods, displacements, way);
    }
    has_shortened = limit_to_sides(rods, displacements, round >= settling_round);
    ++round;
    // What is stopped moves against what is not: it may get further beside that than before.
  } while (has_shortened && !is_known(rods, displacements, way) &&
           largest_square(displacements) > 0.0);
}

/// What one pair stops, another may follow into: until none has to be stopped. Planes that make
/// room for what wants to move could do so by less and less for ever: after some passes those
/// around what is still being stopped do not move any more. A pair that was stopped by such a plane
/// stays on its sides of it, which ends it.
bool FiberContact::limit_to_sides(const Rods& rods, std::vector<Vector3d>& displacements,
                                  bool is_settling) const {
  constexpr int moving_passes = 8;
  std::vector<bool> is_fixed(displacements.size(), is_settling);
  bool has_shortened = false;
  bool is_settled = false;
  for (int pass = 0; !is_settled; ++pass) {
    is_settled = true;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const std::uint32_t a = candidates_[i].edge_a;
      const std::uint32_t b = candidates_[i].edge_b;
      const bool fixed = is_fixed[a] || is_fixed[a + 1] || is_fixed[b] || is_fixed[b + 1];
      if (keep_apart(rods, i, fixed, displacements)) {
        is_settled = false;
        has_shortened = true;
        if (pass >= moving_passes) {
          is_fixed[a] = is_fixed[a + 1] = is_fixed[b] = is_fixed[b + 1] = true;
        }
      }
    }
  }
  return has_shortened;
}

void FiberContact::join(const Rods& rods, const std::vector<Vector3d>& displacements,
                        Islands& islands) {
  if (!is_known(rods, displacements, Way::SHARES) &&
      !look_further(rods, displacements, Way::SHARES)) {
    for (std::uint32_t rod = 1; rod < rods.count(); ++rod) {
      islands.join(0, rod);
    }
  }
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    if (islands.of(candidate.rod_a) == islands.of(candidate.rod_b)) {
      continue;
    }
    const Vector3d& normal = partings_[i].normal;
    double farthest_a = -std::numeric_limits<double>::infinity();
    double nearest_b = std::numeric_limits<double>::infinity();
    for (std::uint32_t end = 0; end < 2; ++end) {
      const std::uint32_t a = candidate.edge_a + end;
      const std::uint32_t b = candidate.edge_b + end;
      farthest_a = std::max(
          farthest_a, normal.dot(rods.positions[a]) + std::max(0.0, normal.dot(displacements[a])));
      nearest_b = std::min(
          nearest_b, normal.dot(rods.positions[b]) + std::min(0.0, normal.dot(displacements[b])));
    }
    const double touching = rods.radii[candidate.rod_a] + rods.radii[candidate.rod_b];
    if (!(nearest_b - farthest_a > std::max(touching, partings_[i].room))) {
      islands.join(candidate.rod_a, candidate.rod_b);
    }
  }
}

}  // namespace fiber
