#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Fibres with fewer segments that enclose given ones: runs of consecutive segments are replaced by
/// one piece from the first point of the run to its last, as thick as it takes.
///
/// A piece's deviation e is at least the distance of every point of its run from its axis. Distance
/// from a segment is convex, so what holds for the points holds for all of the run's axis. And the
/// axis of the run starts and ends where that of the piece does, so its projection onto the piece,
/// which is continuous, passes every point of it: each has a point of the run within e. Both axes
/// are therefore within a Hausdorff distance of e, and of two runs that are within e and f of their
/// pieces the distance differs from that of the pieces by at most e + f.
class SimplifiedFibers {
 public:
  /// Simplifies these, in time linear in their points, and keeps its memory. Longest runs are not
  /// looked for, only long ones, of up to most_segments.
  /// @param deviation [m] >= 0; of a run, e and the difference of its radii are together at most
  /// this
  void update(const FiberAssembly& fibers, double deviation);

  static constexpr std::uint32_t most_segments = 64;

  /// The pieces: the same fibres, and points of theirs. A piece has the largest radius of its run
  /// and e, rounded up.
  const FiberAssembly& assembly() const { return assembly_; }

  /// The run of the piece that starts at this point of assembly(): the segments of the fibres that
  /// start at their points run_begin() … run_end() − 1.
  std::uint32_t run_begin(std::uint32_t piece) const { return origins_[piece]; }
  std::uint32_t run_end(std::uint32_t piece) const { return origins_[piece + 1]; }

  /// e [m]; 0 of a piece that is a segment.
  double deviation(std::uint32_t piece) const { return deviations_[piece]; }

  /// [m] By at most how much more the gap between the run and anything may be than that of the
  /// piece, which is never more than the run's: e, and what the piece is thicker than the thinnest
  /// segment. At most twice the deviation of update(), but for rounding; 0 of a segment.
  double spread(std::uint32_t piece) const { return spreads_[piece]; }

  /// [m] Every segment of the run goes on by at least this along the piece, rounded down; negative
  /// if one goes back.
  double advance(std::uint32_t piece) const { return advances_[piece]; }

  /// A place on the axis of a fibre.
  struct Place {
    std::uint32_t point = 0;  ///< first one of the segment
    double s = 0.0;           ///< in [0, 1]
  };

  /// Where the run of a piece has a point within e of the one on the piece.
  /// @param fibers those of the last update()
  /// @param s parameter on the piece, in [0, 1]
  Place place(const FiberAssembly& fibers, std::uint32_t piece, double s) const;

  std::size_t memory_bytes() const;

 private:
  struct Run {
    std::uint32_t end = 0;   // its last point
    double deviation = 0.0;  // [m]
    double radius = 0.0;     // [m] of the piece
    double spread = 0.0;     // [m]
    double advance = 0.0;    // [m]
  };

  static Run segment(const FiberAssembly& fibers, std::uint32_t begin);
  static bool simplify(const FiberAssembly& fibers, std::uint32_t begin, std::uint32_t end,
                       double deviation, Run& run);
  static Run longest_run(const FiberAssembly& fibers, std::uint32_t begin, std::uint32_t fiber_end,
                         double deviation);
  void add(const FiberAssembly& fibers, std::uint32_t point, const Run& run);

  FiberAssembly assembly_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> offsets_;
  std::vector<double> radii_;           // [m] of pieces, as the next three
  std::vector<double> deviations_;      // [m]
  std::vector<double> spreads_;         // [m]
  std::vector<double> advances_;        // [m]
  std::vector<std::uint32_t> origins_;  // by point of assembly(): the point of the fibres
};

}  // namespace fiber
