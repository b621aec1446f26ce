#include "src/ros/environment/cloud_cells.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace fiber_proximity_ros {
namespace {

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
  add(counts.too_far, "further than ", fiber::OccupancyOctree::half_of_cells * resolution,
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
    if (!point.allFinite()) {
      ++counts.not_finite;
    } else if (!options_.box.contains(point)) {
      ++counts.outside_box;
    } else if (const auto cell = fiber::OccupancyOctree::cell_at(options_.resolution, point)) {
      double& last = cells_.try_emplace(*cell, time).first->second;
      last = std::max(last, time);
    } else {
      ++counts.too_far;
    }
  }
  return counts;
}

std::shared_ptr<const fiber::OccupancyOctree> CloudCells::octree() const {
  if (cells_.empty()) {
    return nullptr;
  }
  std::vector<fiber::OccupancyOctree::Cell> cells;
  cells.reserve(cells_.size());
  for (const auto& [cell, time] : cells_) {
    cells.push_back(cell);
  }
  return std::make_shared<const fiber::OccupancyOctree>(options_.resolution, std::move(cells));
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
