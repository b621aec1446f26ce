#include "src/ros/environment/cloud_cells.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace fiber_proximity_ros {
namespace {

constexpr double half_range = 32768.0;  // [cell] from the origin, along each axis
constexpr unsigned index_bits = 16;
constexpr std::uint64_t index_mask = 0xFFFFU;

void check(const CloudOptions& options) {
  std::ostringstream message;
  if (!(options.resolution > 0.0 && std::isfinite(options.resolution))) {
    message << "resolution of the cloud is " << options.resolution
            << " m, it must be positive and finite";
  } else if (!(options.decay >= 0.0 && std::isfinite(options.decay))) {
    message << "decay of the cloud is " << options.decay << " s, it must be at least 0 and finite";
  } else if (!(options.box.min().array() <= options.box.max().array()).all()) {
    message << "box of the cloud goes from (" << options.box.min().transpose() << ") to ("
            << options.box.max().transpose() << "), the minimum must be at most the maximum";
  } else {
    return;
  }
  throw std::invalid_argument(message.str());
}

}  // namespace

std::string reasons_of(const CloudCounts& counts, double resolution) {
  std::ostringstream reasons;
  const auto add = [&reasons](std::size_t count, const auto&... what) {
    if (count > 0) {
      reasons << (reasons.tellp() > 0 ? ", " : "") << count << (count == 1 ? " is " : " are ");
      (reasons << ... << what);
    }
  };
  add(counts.not_finite, "not finite");
  add(counts.outside_box, "outside the box");
  add(counts.too_far, "further than ", half_range * resolution,
      " m from the origin of the fixed frame along an axis (is the unit metres?)");
  return reasons.str();
}

CloudCells::CloudCells(const CloudOptions& options) : options_(options) { check(options); }

CloudCounts CloudCells::add(const std::vector<Eigen::Vector3d>& points,
                            const Eigen::Isometry3d& pose, double time) {
  forget(time);
  CloudCounts counts;
  counts.points = points.size();
  for (const Eigen::Vector3d& seen : points) {
    const Eigen::Vector3d point = pose * seen;
    Cell cell = 0;
    if (!point.allFinite()) {
      ++counts.not_finite;
    } else if (!options_.box.contains(point)) {
      ++counts.outside_box;
    } else if (!find_cell(point, cell)) {
      ++counts.too_far;
    } else {
      double& last = cells_.try_emplace(cell, time).first->second;
      last = std::max(last, time);
    }
  }
  return counts;
}

std::shared_ptr<const fiber::OccupancyOctree> CloudCells::octree() const {
  if (cells_.empty()) {
    return nullptr;
  }
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(cells_.size());
  for (const auto& [cell, time] : cells_) {
    centres.push_back(centre_of(cell));
  }
  return std::make_shared<const fiber::OccupancyOctree>(options_.resolution, centres);
}

bool CloudCells::find_cell(const Eigen::Vector3d& point, Cell& cell) const {
  cell = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double index = std::floor(point[axis] / options_.resolution) + half_range;
    if (!(index >= 0.0 && index < 2.0 * half_range)) {
      return false;
    }
    cell = cell << index_bits | static_cast<Cell>(index);
  }
  return true;
}

Eigen::Vector3d CloudCells::centre_of(Cell cell) const {
  const auto along = [this](Cell index) {
    return (static_cast<double>(index & index_mask) - half_range + 0.5) * options_.resolution;
  };
  return {along(cell >> (2 * index_bits)), along(cell >> index_bits), along(cell)};
}

void CloudCells::forget(double time) {
  if (options_.decay == 0.0 || time < newest_ - options_.decay) {
    cells_.clear();
    newest_ = time;
    return;
  }
  newest_ = std::max(newest_, time);
  for (auto cell = cells_.begin(); cell != cells_.end();) {
    cell = newest_ - cell->second > options_.decay ? cells_.erase(cell) : std::next(cell);
  }
}

}  // namespace fiber_proximity_ros
