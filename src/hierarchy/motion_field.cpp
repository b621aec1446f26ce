#include "src/hierarchy/motion_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr std::size_t most_sampled = 4096;
constexpr double points_per_cell = 64.0;  // fewer cells for few points

// Means of what is around a node are off where that is not around it evenly: once more, then.
constexpr int corrections = 2;

constexpr int fill_sweeps = 8;

// Nodes with less of the sample around them would follow single points.
constexpr double least_weight = 0.5;

}  // namespace

void MotionField::reserve(std::size_t points) {
  if (points == 0) {
    return;
  }
  constexpr std::size_t most_nodes = (most_cells + 1) * (most_cells + 1) * (most_cells + 1);
  nodes_.reserve(most_nodes);
  weights_.reserve(most_nodes);
  sums_.reserve(most_nodes);
  are_known_.reserve(most_nodes);
  terms_.reserve(std::size_t{most_cells} * most_cells * most_cells);
}

void MotionField::start(const std::vector<Vector3d>& points, const Vector3d& lower,
                        const Vector3d& upper) {
  lower_ = lower;
  upper_ = upper;
  stride_ = 1 + points.size() / most_sampled;
  const Vector3d extents = upper - lower;
  const double extent = extents.maxCoeff();
  const double cells =
      std::clamp(std::round(std::cbrt(static_cast<double>(points.size()) / points_per_cell)), 1.0,
                 double{most_cells});
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
    const std::size_t x = cell % cells_[0];
    const std::size_t y = cell / cells_[0] % cells_[1];
    const std::size_t z = cell / cells_[0] / cells_[1];
    for (std::size_t corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      for (int axis = 0; axis < 3; ++axis) {
        weight *= (corner >> axis & 1U) != 0 ? part[axis] : 1.0 - part[axis];
      }
      const std::size_t at =
          node(x + (corner & 1U), y + (corner >> 1U & 1U), z + (corner >> 2U & 1U));
      weights_[at] += weight;
      sums_[at] += weight * off;
    }
  }
  const double least = std::min(least_weight, *std::max_element(weights_.begin(), weights_.end()));
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

/// Calls function(cell, displacements at its corners), bit a of whose index is that of axis a.
template <class Function>
void MotionField::for_each_cell(const Function& function) const {
  std::size_t cell = 0;
  for (std::size_t z = 0; z < cells_[2]; ++z) {
    for (std::size_t y = 0; y < cells_[1]; ++y) {
      for (std::size_t x = 0; x < cells_[0]; ++x) {
        Terms corners;
        for (std::size_t i = 0; i < corners.size(); ++i) {
          corners[i] = nodes_[node(x + (i & 1U), y + (i >> 1U & 1U), z + (i >> 2U & 1U))];
        }
        function(cell++, corners);
      }
    }
  }
}

void MotionField::find_terms() {
  for_each_cell([&](std::size_t cell, Terms corners) {
    for (const std::size_t bit : {1U, 2U, 4U}) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if ((i & bit) != 0) {
          corners[i] -= corners[i ^ bit];
        }
      }
    }
    terms_[cell] = corners;
  });
}

/// Along an axis the field changes the most at an edge of a cell.
void MotionField::find_bounds() {
  double squared = 0.0;
  for_each_cell([&](std::size_t /*cell*/, const Terms& corners) {
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
  });
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
  // Of a place in a cell, and of the sums of eight terms.
  rounding_ = 64.0 * epsilon * (rate_ * (lower_.norm() + upper_.norm()) + largest);
  beyond_drift_ += rounding_;
}

std::size_t MotionField::memory_bytes() const {
  return (nodes_.capacity() + sums_.capacity()) * sizeof(Vector3d) +
         weights_.capacity() * sizeof(double) + are_known_.capacity() +
         terms_.capacity() * sizeof(Terms);
}

}  // namespace fiber
