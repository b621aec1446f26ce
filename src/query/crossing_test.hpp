#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "src/geometry/perturbed_orientation.hpp"

namespace fiber {

/// Decides whether two segments cross in a view: by doubles where their error leaves no doubt, else
/// in integers.
///
/// Two lines of sight tell all. The side of the plane through the viewer and one segment on which
/// an end of the other is, is the orientation of the four points; the images cross where the ends
/// are on different sides, both ways, and the sides' volumes divide the segments there. Behind the
/// eye this holds for the ray's other half, so it takes a look at which half it is. The orientation
/// of the four ends themselves is the sign of the crossing.
class CrossingTest {
 public:
  /// Refers to both, which must outlive it; the view is valid.
  CrossingTest(const FiberAssembly& fibers, const View& view);

  /// @param point_a first point of the one segment
  /// @param point_b of the other, larger
  std::optional<Crossing> operator()(std::uint32_t point_a, std::uint32_t point_b) const;

 private:
  /// Where they cross and what the perturbation cannot change, or is what decides.
  struct Place {
    double s;
    double t;
    int sign;
    bool a_is_over;
  };
  enum class Verdict { APART, CROSSING, OPEN };

  /// First and last points of a and of b.
  using Ends = std::array<std::uint32_t, 4>;

  bool is_pair(const Ends& ends) const;
  Verdict judge_in_doubles(const Ends& ends, Place& place) const;
  std::optional<Place> judge_in_integers(const Ends& ends) const;
  Crossing crossing_at(const Ends& ends, const Place& place) const;

  const FiberAssembly& fibers_;
  const View& view_;
  std::vector<std::uint32_t> joints_;  // of each point: that of the points it moves with
};

}  // namespace fiber
