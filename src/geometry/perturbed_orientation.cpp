#include "src/geometry/perturbed_orientation.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace fiber {
namespace {

using Row = std::array<Integer, 4>;

/// By Laplace's expansion along two rows.
Integer determinant(const std::array<Row, 4>& rows) {
  const auto minor = [&rows](std::size_t row, std::size_t i, std::size_t j) -> Integer {
    return rows[row][i] * rows[row + 1][j] - rows[row + 1][i] * rows[row][j];
  };
  return minor(0, 0, 1) * minor(2, 2, 3) - minor(0, 0, 2) * minor(2, 1, 3) +
         minor(0, 0, 3) * minor(2, 1, 2) + minor(0, 1, 2) * minor(2, 0, 3) -
         minor(0, 1, 3) * minor(2, 0, 2) + minor(0, 2, 3) * minor(2, 0, 1);
}

/// Goes through the terms of a perturbed determinant from the largest down.
class TermSearch {
 public:
  explicit TermSearch(const std::array<PerturbedPoint, 4>& points) : points_(points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      rows_[i] = points[i].coordinates;
      if (points[i].id) {
        smallest_first_.push_back(i);
      }
    }
    std::sort(smallest_first_.begin(), smallest_first_.end(),
              [&points](std::size_t i, std::size_t j) { return *points[i].id > *points[j].id; });
  }

  LeadingTerm first() {
    [[maybe_unused]] const bool found = find(0);
    assert(found);
    return {-determinant_, perturbations_};
  }

 private:
  /// Terms without the smallest perturbation come before those with it: of the point whose
  /// perturbation is smallest, the outermost loop looks at the point itself, then at its axes.
  bool find(std::size_t depth) {
    if (depth == smallest_first_.size()) {
      determinant_ = determinant(rows_);
      return determinant_ != 0;
    }
    if (find(depth + 1)) {
      return true;
    }
    const std::size_t row = smallest_first_[depth];
    const std::size_t place = used_++;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows_[row] = {0, 0, 0, 0};
      rows_[row][axis] = 1;
      perturbations_[place] = 1 + 3 * std::uint64_t{*points_[row].id} + axis;
      if (find(depth + 1)) {
        return true;
      }
    }
    perturbations_[place] = 0;
    used_ = place;
    rows_[row] = points_[row].coordinates;
    return false;
  }

  const std::array<PerturbedPoint, 4>& points_;
  std::array<Row, 4> rows_;
  std::vector<std::size_t> smallest_first_;  // rows by the size of their perturbation
  Integer determinant_ = 0;
  std::array<std::uint64_t, 4> perturbations_{};
  std::size_t used_ = 0;
};

}  // namespace

LeadingTerm perturbed_orientation(const std::array<PerturbedPoint, 4>& points) {
  return TermSearch(points).first();
}

}  // namespace fiber
