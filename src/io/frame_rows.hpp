#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"

namespace fiber {

/// Rows of a frame in a file's order.
struct FrameRows {
  /// Rows of one fibre that follow each other, up to the next of the runs.
  struct Run {
    std::uint32_t name = 0;  ///< FrameBuilder::number_of()
    std::size_t begin = 0;   ///< among the points
    std::size_t line = 0;    ///< of the first one
  };

  std::int64_t number = 0;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> radii;         ///< of the points [m], or none
  std::vector<std::uint8_t> closed;  ///< whether the point is of a closed fibre, or none
  std::vector<std::int32_t> joints;  ///< of the points, as FiberTopology has them, or none
  std::vector<Run> runs;
};

/// Makes frames of the rows of a file. Fibres are in the order in which their names appear, and the
/// points of a fibre in that of its rows.
class FrameBuilder {
 public:
  /// The number of a name, the same in all frames.
  std::uint32_t number_of(std::string_view name);

  /// @param file what errors call it
  /// @throws FileError for a fibre of one point that is not to be skipped, for one that is closed
  /// in
  ///         some of its rows only, and for joints whose points do not meet
  FiberFrame build(FrameRows rows, const std::string& file, const ReadOptions& options);

  /// A joint of one point alone, the first of all frames, and its frame.
  const std::optional<std::pair<std::int64_t, std::int32_t>>& lonely_joint() const {
    return lonely_joint_;
  }

  /// How many fibres of one point were left out, of all frames.
  std::size_t skipped() const { return skipped_; }

  /// A fibre whose rows did not stand one after another in a frame that was built, "" for none.
  const std::string& scattered() const { return scattered_; }

 private:
  void find_fibers(const FrameRows& rows);
  void forget_fibers();
  void bring_together(FrameRows& rows);
  bool skip_single_points(FrameRows& rows);
  void require_segments(const FrameRows& rows, const std::string& file) const;
  FiberTopology topology_of(const FrameRows& rows, const std::string& file);
  FiberNames names_of_fibers();

  std::deque<std::string> names_;  // by number
  std::unordered_map<std::string_view, std::uint32_t> numbers_;
  std::uint32_t last_ = 0;                     // of number_of()
  std::vector<std::uint32_t> fibers_;          // of the frame that is built, by number of the name
  std::vector<std::uint32_t> names_in_frame_;  // by fibre
  std::vector<std::uint32_t> offsets_;

  std::string scattered_;
  std::size_t skipped_ = 0;
  std::optional<std::pair<std::int64_t, std::int32_t>> lonely_joint_;

  // These are of the frame before.
  std::vector<std::uint32_t> names_before_;
  FiberNames fiber_names_;
};

}  // namespace fiber
