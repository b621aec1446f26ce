#include "src/hierarchy/motion_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
// So few that following them takes next to nothing beside a look at every point.
constexpr std::size_t sampled_of = 64;  // points one
constexpr std::size_t max_sampled = 4096;
constexpr double sampled_per_cell = 8.0;

// Means of what is around a node are off where that is not around it evenly: once more, then.
constexpr int corrections = 2;

constexpr int fill_sweeps = 8;

// Nodes with less of the sample around them would follow single points.
constexpr double min_weight = 0.5;

}  // namespace

void MotionField::reserve(std::size_t points) {
  if (points == 0) {
    return;
  }
  constexpr std::size_t max_nodes = (max_cells + 1) * (max_cells + 1) * (max_cells + 1);
  nodes_.reserve(max_nodes);
  weights_.reserve(max_nodes);
  sums_.reserve(max_nodes);
  are_known_.reserve(max_nodes);
  constexpr std::size_t all_cells = std::size_t{max_cells} * max_cells * max_cells;
  terms_.reserve(all_cells);
  first_nodes_.reserve(all_cells);
}

void MotionField::start(const std::vector<Vector3d>& points, const Vector3d& lower,
                        const Vector3d& upper) {
  lower_ = lower;
  upper_ = upper;
  stride_ = std::max(sampled_of, 1 + points.size() / max_sampled);
  const Vector3d extents = upper - lower;
  const double extent = extents.maxCoeff();
  const double cells = std::clamp(
      std::round(std::cbrt(static_cast<double>(points.size() / stride_) / sampled_per_cell)), 1.0,
      double{max_cells});
  // Cells are cubes: a flat scene has one layer of them.
  cells_per_meter_ = extent > 0.0 ? cells / extent : 1.0;
  std::size_t cell_count = 1;
  std::size_t node_count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil(extents[axis] * cells_per_meter_);
    cells_[axis] = static_cast<std::size_t>(std::clamp(count, 1.0, cells));
    cell_count *= cells_[axis];
    node_count *= cells_[axis] + 1;
  }
  nodes_.assign(node_count, Vector3d::Zero());
  weights_.resize(node_count);
  sums_.resize(node_count);
  are_known_.resize(node_count);
  terms_.resize(cell_count);
  find_corners();
  find_terms();
}

double MotionField::sampled_motion(const std::vector<Vector3d>& before,
                                   const std::vector<Vector3d>& now) const {
  double squared = 0.0;
  for (std::size_t i = 0; i < before.size(); i += stride_) {
    squared = std::max(squared, (now[i] - before[i]).squaredNorm());
  }
  return std::sqrt(squared);
}

double MotionField::follow(const std::vector<Vector3d>& before, const std::vector<Vector3d>& now) {
  for (int i = 0; i < corrections; ++i) {
    correct(before, now);
    fill();
    find_terms();
  }
  find_bounds();
  double squared = 0.0;
  for (std::size_t i = 0; i < before.size(); i += stride_) {
    squared = std::max(squared, (now[i] - before[i] - at(before[i])).squaredNorm());
  }
  return std::sqrt(squared);
}

/// Moves each node by the mean of what the sample around it is off.
void MotionField::correct(const std::vector<Vector3d>& before, const std::vector<Vector3d>& now) {
  std::fill(weights_.begin(), weights_.end(), 0.0);
  std::fill(sums_.begin(), sums_.end(), Vector3d::Zero());
  for (std::size_t i = 0; i < before.size(); i += stride_) {
    Vector3d part;
    const std::size_t cell = cell_of(before[i], part);
    const Vector3d off = now[i] - before[i] - value(cell, part);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const double weight = ((corner & 1U) != 0 ? part.x() : 1.0 - part.x()) *
                            ((corner & 2U) != 0 ? part.y() : 1.0 - part.y()) *
                            ((corner & 4U) != 0 ? part.z() : 1.0 - part.z());
      const std::size_t at = first_nodes_[cell] + corner_nodes_[corner];
      weights_[at] += weight;
      sums_[at] += weight * off;
    }
  }
  const double least = std::min(min_weight, *std::max_element(weights_.begin(), weights_.end()));
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    are_known_[i] = weights_[i] >= least ? 1 : 0;
    if (are_known_[i] != 0) {
      nodes_[i] += sums_[i] / weights_[i];
    }
  }
}

/// Nodes without a sample around them become the mean of those next to them, as in a membrane that
/// is held by the others (Gauss and Seidel's iteration, to and fro, from where they were).
void MotionField::fill() {
  for (int sweep = 0; sweep < fill_sweeps; ++sweep) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const std::size_t here = sweep % 2 == 0 ? i : nodes_.size() - 1 - i;
      if (are_known_[here] == 0) {
        nodes_[here] = mean_around(here);
      }
    }
  }
}

Vector3d MotionField::mean_around(std::size_t here) const {
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  std::size_t left = here;
  std::size_t stride = 1;
  for (const std::size_t cells : cells_) {
    const std::size_t place = left % (cells + 1);
    left /= cells + 1;
    if (place > 0) {
      sum += nodes_[here - stride];
      count += 1.0;
    }
    if (place < cells) {
      sum += nodes_[here + stride];
      count += 1.0;
    }
    stride *= cells + 1;
  }
  return sum / count;
}

/// Finds the first node of each cell, and where the nodes at its corners are from there: bit a of a
/// corner's index is that of axis a.
void MotionField::find_corners() {
  const std::size_t along_y = cells_[0] + 1;
  const std::size_t along_z = along_y * (cells_[1] + 1);
  first_nodes_.clear();
  for (std::size_t z = 0; z < cells_[2]; ++z) {
    for (std::size_t y = 0; y < cells_[1]; ++y) {
      for (std::size_t x = 0; x < cells_[0]; ++x) {
        first_nodes_.push_back(z * along_z + y * along_y + x);
      }
    }
  }
  for (std::size_t i = 0; i < corner_nodes_.size(); ++i) {
    corner_nodes_[i] = (i & 1U) + (i >> 1U & 1U) * along_y + (i >> 2U & 1U) * along_z;
  }
}

/// The displacements at the corners of a cell.
MotionField::Terms MotionField::corners_of(std::size_t cell) const {
  Terms corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = nodes_[first_nodes_[cell] + corner_nodes_[i]];
  }
  return corners;
}

void MotionField::find_terms() {
  for (std::size_t cell = 0; cell < terms_.size(); ++cell) {
    Terms& terms = terms_[cell];
    terms = corners_of(cell);
    for (const std::size_t bit : {1U, 2U, 4U}) {
      for (std::size_t i = 0; i < terms.size(); ++i) {
        if ((i & bit) != 0) {
          terms[i] -= terms[i ^ bit];
        }
      }
    }
  }
}

/// Along an axis the field changes the most at an edge of a cell.
void MotionField::find_bounds() {
  double squared = 0.0;
  for (std::size_t cell = 0; cell < terms_.size(); ++cell) {
    const Terms corners = corners_of(cell);
    double of_cell = 0.0;
    for (const std::size_t bit : {1U, 2U, 4U}) {
      double of_axis = 0.0;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if ((i & bit) != 0) {
          of_axis = std::max(of_axis, (corners[i] - corners[i ^ bit]).squaredNorm());
        }
      }
      of_cell += of_axis;
    }
    squared = std::max(squared, of_cell);
  }
  rate_ = (1.0 + 32.0 * epsilon) * std::sqrt(squared) * cells_per_meter_;
  drift_ = Vector3d::Zero();
  for (const Vector3d& displacement : nodes_) {
    drift_ += displacement / static_cast<double>(nodes_.size());
  }
  beyond_drift_ = 0.0;
  double largest = 0.0;
  for (const Vector3d& displacement : nodes_) {
    beyond_drift_ = std::max(beyond_drift_, (displacement - drift_).norm());
    largest = std::max(largest, displacement.norm());
  }
  // The rounding of a place in a cell, and of the sums of eight terms.
  rounding_ = 64.0 * epsilon * (rate_ * (lower_.norm() + upper_.norm()) + largest);
  beyond_drift_ += rounding_;
}

std::size_t MotionField::memory_bytes() const {
  return (nodes_.capacity() + sums_.capacity()) * sizeof(Vector3d) +
         weights_.capacity() * sizeof(double) + are_known_.capacity() +
         terms_.capacity() * sizeof(Terms) + first_nodes_.capacity() * sizeof(std::size_t);
}

}  // namespace fiber
