#include "src/ros/inputs/missing_points.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <unordered_set>
#include <utility>

#include "src/ros/inputs/closed_fibers.hpp"

namespace fiber_proximity_ros {
namespace {

bool is_missing(const Eigen::Vector3d& point) { return !point.allFinite(); }

[[noreturn]] void refuse_first(const FiberBuffer& fibers) {
  const auto missing = std::find_if(fibers.points.begin(), fibers.points.end(), is_missing);
  const auto index = static_cast<std::uint32_t>(missing - fibers.points.begin());
  const auto next = std::upper_bound(fibers.offsets.begin(), fibers.offsets.end(), index);
  int axis = 0;
  while (std::isfinite((*missing)[axis])) {
    ++axis;
  }
  std::ostringstream message;
  message << "fibre " << next - fibers.offsets.begin() - 1 << ", point " << index - *(next - 1)
          << ": "
          << "xyz"[axis] << " is " << (*missing)[axis] << ", "
          << fiber::FiberAssembly::coordinate_rule
          << "; with missing_points: bridge or split such points are left out";
  throw std::invalid_argument(message.str());
}

/// Takes the missing points out of a buffer, in place: known points move towards its front.
class GapCloser {
 public:
  GapCloser(FiberBuffer& fibers, MissingPointCounts& counts)
      : fibers_(fibers),
        counts_(counts),
        has_radius_per_point_(fibers.has_radius_per_point()),
        has_radius_per_fiber_(fibers.radii.size() > 1 && !has_radius_per_point_),
        offsets_before_(std::exchange(fibers.offsets, {0})),
        names_before_(std::exchange(fibers.names, {})),
        closed_before_(std::exchange(fibers.topology.closed, {})) {
    if (has_radius_per_fiber_) {
      radii_before_ = std::exchange(fibers.radii, {});
    }
  }

  /// Joins the neighbours of missing points.
  void bridge() { close(false); }

  /// Cuts fibres at missing points.
  void split() { close(true); }

 private:
  void close(bool cuts) {
    for (std::size_t fiber = 0; fiber + 1 < offsets_before_.size(); ++fiber) {
      close(fiber, cuts);
    }
    fibers_.points.resize(end_);
    if (has_radius_per_point_) {
      fibers_.radii.resize(end_);
    }
    if (has_joints()) {
      fibers_.topology.joints.resize(end_);
    }
  }

  bool has_joints() const { return !fibers_.topology.joints.empty(); }

  void close(std::size_t fiber, bool cuts) {
    const std::size_t fibers_before = fibers_.fiber_count();
    std::uint64_t gap = 0;  // points since the last known one
    for (std::uint32_t i = offsets_before_[fiber]; i < offsets_before_[fiber + 1]; ++i) {
      if (is_missing(fibers_.points[i])) {
        ++gap;
        if (cuts) {
          end_piece(fiber, fibers_before);
        }
        continue;
      }
      if (end_ == fibers_.offsets.back()) {  // a piece begins
        counts_.gaps += gap;
        piece_begin_ = i;
      }
      gap = 0;
      keep(i);
    }
    counts_.gaps += gap;
    end_piece(fiber, fibers_before);
    counts_.fibers += fibers_.fiber_count() == fibers_before ? 1 : 0;
  }

  void keep(std::uint32_t point) {
    fibers_.points[end_] = fibers_.points[point];
    if (has_radius_per_point_) {
      fibers_.radii[end_] = fibers_.radii[point];
    }
    if (has_joints()) {
      fibers_.topology.joints[end_] = fibers_.topology.joints[point];
    }
    ++end_;
  }

  /// Makes the known points since the last piece a fibre, but for a lone one, which it drops.
  void end_piece(std::size_t fiber, std::size_t fibers_before) {
    const std::uint32_t begin = fibers_.offsets.back();
    if (end_ - begin < 2) {
      counts_.lone_points += end_ - begin;
      end_ = begin;
      return;
    }
    if (!names_before_.empty()) {
      const std::string& name = names_before_[fiber];
      fibers_.names.push_back(fibers_.fiber_count() == fibers_before
                                  ? name
                                  : piece_name(name, piece_begin_ - offsets_before_[fiber]));
    }
    if (has_radius_per_fiber_) {
      fibers_.radii.push_back(radii_before_[fiber]);
    }
    if (!closed_before_.empty()) {
      constexpr std::uint32_t min_closed_points = 3;
      fibers_.topology.closed.push_back(end_ - begin < min_closed_points ? 0
                                                                         : closed_before_[fiber]);
    }
    fibers_.offsets.push_back(end_);
  }

  std::string piece_name(const std::string& name, std::uint32_t first_point) {
    if (taken_names_.empty()) {
      taken_names_.insert(names_before_.begin(), names_before_.end());
    }
    const std::string suffix = "[" + std::to_string(first_point) + "]";
    std::string piece = name + suffix;
    while (!taken_names_.insert(piece).second) {
      piece += suffix;  // the tracker itself has called a fibre so
    }
    return piece;
  }

  FiberBuffer& fibers_;
  MissingPointCounts& counts_;
  bool has_radius_per_point_;
  bool has_radius_per_fiber_;
  std::vector<std::uint32_t> offsets_before_;
  std::vector<std::string> names_before_;
  std::vector<std::uint8_t> closed_before_;
  std::vector<double> radii_before_;  // by fibre
  std::uint32_t end_ = 0;             // of the points kept so far
  std::uint32_t piece_begin_ = 0;     // where the piece's first point was
  std::unordered_set<std::string> taken_names_;
};

}  // namespace

void resolve_missing_points(MissingPoints policy, FiberBuffer& fibers, MissingPointCounts& counts) {
  const auto missing = std::count_if(fibers.points.begin(), fibers.points.end(), is_missing);
  if (missing == 0 || !has_sound_layout(fibers)) {
    return;
  }
  counts.points += static_cast<std::uint64_t>(missing);
  switch (policy) {
    case MissingPoints::REFUSE:
      refuse_first(fibers);
    case MissingPoints::BRIDGE:
      GapCloser(fibers, counts).bridge();
      break;
    case MissingPoints::SPLIT:
      if (!fibers.topology.closed.empty()) {
        open_rings(fibers);
      }
      GapCloser(fibers, counts).split();
      break;
  }
}

}  // namespace fiber_proximity_ros
