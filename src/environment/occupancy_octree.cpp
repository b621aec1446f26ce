#include "fiber_proximity/environment/occupancy_octree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "src/environment/convex_solids.hpp"
#include "src/hierarchy/sort_keys.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Bits of a cell's index along each axis; as many levels of an octree.
constexpr int morton_levels = 16;
static_assert(OccupancyOctree::half_of_cells == 1 << (morton_levels - 1));

/// Every third bit of these becomes one of 16 bits in a row.
std::uint32_t every_third_bit(std::uint64_t code) {
  std::uint64_t x = code & 0x1249249249249249U;
  x = (x | x >> 2U) & 0x10c30c30c30c30c3U;
  x = (x | x >> 4U) & 0x100f00f00f00f00fU;
  x = (x | x >> 8U) & 0x001f0000ff0000ffU;
  x = (x | x >> 16U) & 0x001f00000000ffffU;
  return static_cast<std::uint32_t>(x & 0xffffU);
}

/// The other way round.
std::uint64_t two_zeros_between_bits(std::uint32_t bits) {
  std::uint64_t x = bits & 0xffffU;
  x = (x | x << 16U) & 0x001f0000ff0000ffU;
  x = (x | x << 8U) & 0x100f00f00f00f00fU;
  x = (x | x << 4U) & 0x10c30c30c30c30c3U;
  x = (x | x << 2U) & 0x1249249249249249U;
  return x;
}

/// A cell's place on Morton's curve, from its index along each axis, 0 to 65535: three bits per
/// level, the coarsest first, so that what is in one cube of the octree is in a row.
std::uint64_t morton_code(const Eigen::Array3i& cell) {
  const auto bits = [&](int axis) {
    return two_zeros_between_bits(static_cast<std::uint32_t>(cell[axis]));
  };
  return bits(0) | bits(1) << 1U | bits(2) << 2U;
}

/// The index along each axis again.
Eigen::Array3i morton_cell(std::uint64_t code) {
  const auto index = [&](unsigned axis) { return static_cast<int>(every_third_bit(code >> axis)); };
  return {index(0), index(1), index(2)};
}

/// Which of eight children of a cube on this level (0 for the largest) holds a cell: bit 0 where it
/// is the upper half along x, bit 1 along y, bit 2 along z.
unsigned morton_child(std::uint64_t code, int level) {
  return static_cast<unsigned>(code >> (3 * (morton_levels - 1 - level))) & 7U;
}

double checked_resolution(double resolution) {
  if (!(resolution > 0.0 && resolution < std::numeric_limits<double>::infinity())) {
    std::ostringstream message;
    message << "resolution of the octree is " << resolution << " m, it must be positive and finite";
    throw std::invalid_argument(message.str());
  }
  return resolution;
}

/// Where a cube of the octree is: its centre in units of half a cell, which numbers have exactly.
using HalfCells = Eigen::Array3i;

/// Goes to the cells that are within a bound [m] of a box, near ones first, roughly.
/// @tparam Look called with the centre of a cell [m] and the bound, which it may lower
template <class Look>
class CellSearch {
 public:
  using Codes = const std::uint64_t*;

  CellSearch(double resolution, const WorldBox& around, double bound, const Look& look)
      : resolution_(resolution), around_(around), bound_(bound), look_(look) {}

  /// @param codes of the cells, in ascending order
  void search(const std::vector<std::uint64_t>& codes) {
    if (!codes.empty()) {
      visit({codes.data(), codes.data() + codes.size(), HalfCells::Zero(), 0.0}, 0);
    }
  }

 private:
  /// A cube with cells in it.
  struct Cube {
    Codes begin = nullptr;
    Codes end = nullptr;
    HalfCells centre;
    double distance = std::numeric_limits<double>::infinity();  // [m] at least this far
  };

  void visit(const Cube& parent, int level) {
    if (level == morton_levels) {
      look_(position(parent.centre), bound_);
      return;
    }
    const int step = 1 << (morton_levels - level - 1);
    std::array<Cube, 8> children;
    std::size_t count = 0;
    for (Codes begin = parent.begin; begin != parent.end; ++count) {
      const unsigned place = morton_child(*begin, level);
      Cube& child = children[count];
      child.begin = begin;
      child.end = begin = std::partition_point(begin, parent.end, [&](std::uint64_t code) {
        return morton_child(code, level) == place;
      });
      child.centre =
          parent.centre + step * HalfCells(sign(place & 1U), sign(place & 2U), sign(place & 4U));
      child.distance = around_.exteriorDistance(box(child.centre, step));
    }
    const auto end = children.begin() + static_cast<std::ptrdiff_t>(count);
    std::sort(children.begin(), end,
              [](const Cube& x, const Cube& y) { return x.distance < y.distance; });
    for (auto child = children.begin(); child != end; ++child) {
      if (child->distance > std::max(bound_, 0.0)) {
        return;
      }
      visit(*child, level + 1);
    }
  }

  static int sign(unsigned bit) { return bit != 0 ? 1 : -1; }

  Vector3d position(const HalfCells& centre) const {
    return centre.cast<double>() * (resolution_ / 2.0);
  }

  /// @param half of its edge, in half cells
  WorldBox box(const HalfCells& centre, int half) const {
    return {position(centre - half), position(centre + half)};
  }

  const double resolution_;  // [m]
  const WorldBox& around_;
  double bound_;
  const Look& look_;
};

}  // namespace

std::optional<OccupancyOctree::Cell> OccupancyOctree::cell_at(double resolution,
                                                              const Vector3d& point) {
  const Eigen::Array3d cell = (point.array() / resolution).floor() + double{half_of_cells};
  if (!(cell >= 0.0 && cell < 2.0 * half_of_cells).all()) {  // so it is of NaN
    return std::nullopt;
  }
  return morton_code(cell.cast<int>());
}

OccupancyOctree::OccupancyOctree(double resolution, std::vector<Cell> cells)
    : resolution_(checked_resolution(resolution)), cells_(std::move(cells)) {
  std::vector<Cell> scratch;
  sort_keys(cells_, scratch);
  cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());

  centres_.reserve(cells_.size());
  for (const Cell code : cells_) {
    const Eigen::Array3d cell = (morton_cell(code) - half_of_cells).cast<double>();
    centres_.emplace_back((cell + 0.5) * resolution);
    box_.extend(centres_.back());
  }
  if (!centres_.empty()) {
    box_.min().array() -= resolution / 2.0;
    box_.max().array() += resolution / 2.0;
  }
}

AxisDistance OccupancyOctree::axis_distance(const Vector3d& p0, const Vector3d& p1,
                                            double bound) const {
  const BoxShape cell{Vector3d::Constant(resolution_)};
  AxisDistance best;
  best.distance = std::numeric_limits<double>::infinity();
  best.lower = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vector3d& centre, double& most) {
    const AxisDistance found = fiber::axis_distance(cell, p0 - centre, p1 - centre);
    if (found.distance < best.distance && found.distance <= most) {
      best.s = found.s;
      best.distance = found.distance;
      best.gradient = found.gradient;
      most = found.distance;
    }
    best.lower = std::min(best.lower, found.lower);
  };
  const WorldBox axis_box(p0.cwiseMin(p1), p0.cwiseMax(p1));
  CellSearch(resolution_, axis_box, bound, look).search(cells_);
  return best;
}

void OccupancyOctree::visit_near(const WorldBox& box, double within,
                                 const std::function<void(const Vector3d&)>& visit) const {
  const auto look = [&](const Vector3d& centre, double&) { visit(centre); };
  CellSearch(resolution_, box, within, look).search(cells_);
}

}  // namespace fiber
