#include "src/ros/inputs/missing_points.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <unordered_set>
#include <utility>

namespace fiber_proximity_ros {
namespace {

bool is_missing(const Eigen::Vector3d& point) { return !point.allFinite(); }

/// True if every point belongs to a fibre of two at least, and radii can be told whose they are.
bool has_sound_layout(const FiberBuffer& chains) {
  const std::vector<std::uint32_t>& offsets = chains.offsets;
  const auto is_too_short = [](std::uint32_t begin, std::uint32_t end) {
    return std::uint64_t{end} < std::uint64_t{begin} + 2;
  };
  const std::size_t radii = chains.radii.size();
  return !offsets.empty() && offsets.front() == 0 && offsets.back() == chains.points.size() &&
         std::adjacent_find(offsets.begin(), offsets.end(), is_too_short) == offsets.end() &&
         (radii <= 1 || radii == chains.fiber_count() || radii == chains.points.size());
}

[[noreturn]] void refuse_first(const FiberBuffer& chains) {
  const auto missing = std::find_if(chains.points.begin(), chains.points.end(), is_missing);
  const auto index = static_cast<std::uint32_t>(missing - chains.points.begin());
  const auto next = std::upper_bound(chains.offsets.begin(), chains.offsets.end(), index);
  int axis = 0;
  while (std::isfinite((*missing)[axis])) {
    ++axis;
  }
  std::ostringstream message;
  message << "fibre " << next - chains.offsets.begin() - 1 << ", point " << index - *(next - 1)
          << ": "
          << "xyz"[axis] << " is " << (*missing)[axis] << ", "
          << fiber::FiberAssembly::coordinate_rule
          << "; with missing_points: bridge or split such points are left out";
  throw std::invalid_argument(message.str());
}

/// Copies the known parts of chains, with their names and radii.
class KnownChains {
 public:
  KnownChains(const FiberBuffer& chains, MissingPointCounts& counts)
      : chains_(chains),
        counts_(counts),
        has_radius_per_point_(chains.radii.size() > 1 &&
                              chains.radii.size() == chains.points.size()),
        has_radius_per_fiber_(chains.radii.size() > 1 && !has_radius_per_point_) {
    known_.header = chains.header;
    known_.points.reserve(chains.points.size());
    if (!has_radius_per_point_ && !has_radius_per_fiber_) {
      known_.radii = chains.radii;
    }
  }

  void copy(std::size_t fiber, MissingPoints policy) {
    const std::size_t fibers_before = known_.fiber_count();
    std::uint64_t gap = 0;  // points since the last known one
    for (std::uint32_t i = chains_.offsets[fiber]; i < chains_.offsets[fiber + 1]; ++i) {
      if (is_missing(chains_.points[i])) {
        ++gap;
        if (policy == MissingPoints::SPLIT) {
          end_piece(fiber, fibers_before);
        }
        continue;
      }
      counts_.gaps += piece_.empty() ? gap : 0;
      gap = 0;
      piece_.push_back(i);
    }
    counts_.gaps += gap;
    end_piece(fiber, fibers_before);
    counts_.fibers += known_.fiber_count() == fibers_before ? 1 : 0;
  }

  FiberBuffer take() { return std::move(known_); }

 private:
  void end_piece(std::size_t fiber, std::size_t fibers_before) {
    if (piece_.size() > 1) {
      copy_piece(fiber, known_.fiber_count() == fibers_before);
    }
    counts_.lone_points += piece_.size() == 1 ? 1 : 0;
    piece_.clear();
  }

  void copy_piece(std::size_t fiber, bool is_first) {
    for (const std::uint32_t i : piece_) {
      known_.points.push_back(chains_.points[i]);
      if (has_radius_per_point_) {
        known_.radii.push_back(chains_.radii[i]);
      }
    }
    if (!chains_.names.empty()) {
      const std::string& name = chains_.names[fiber];
      known_.names.push_back(is_first ? name
                                      : piece_name(name, piece_.front() - chains_.offsets[fiber]));
    }
    if (has_radius_per_fiber_) {
      known_.radii.push_back(chains_.radii[fiber]);
    }
    known_.end_chain();
  }

  std::string piece_name(const std::string& name, std::uint32_t first_point) {
    if (taken_names_.empty()) {
      taken_names_.insert(chains_.names.begin(), chains_.names.end());
    }
    const std::string suffix = "[" + std::to_string(first_point) + "]";
    std::string piece = name + suffix;
    while (!taken_names_.insert(piece).second) {
      piece += suffix;  // the tracker itself has called a fibre so
    }
    return piece;
  }

  const FiberBuffer& chains_;
  MissingPointCounts& counts_;
  bool has_radius_per_point_;
  bool has_radius_per_fiber_;
  FiberBuffer known_;
  std::vector<std::uint32_t> piece_;  // indices of its points
  std::unordered_set<std::string> taken_names_;
};

}  // namespace

void handle_missing_points(MissingPoints policy, FiberBuffer& chains, MissingPointCounts& counts) {
  const auto missing = std::count_if(chains.points.begin(), chains.points.end(), is_missing);
  if (missing == 0 || !has_sound_layout(chains)) {
    return;
  }
  counts.points += static_cast<std::uint64_t>(missing);
  if (policy == MissingPoints::REFUSE) {
    refuse_first(chains);
  }
  KnownChains known(chains, counts);
  for (std::size_t fiber = 0; fiber < chains.fiber_count(); ++fiber) {
    known.copy(fiber, policy);
  }
  chains = known.take();
}

}  // namespace fiber_proximity_ros
