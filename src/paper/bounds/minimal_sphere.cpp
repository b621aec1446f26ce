#include "src/paper/bounds/minimal_sphere.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <random>
#include <utility>

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Points whose edges' smallest pivot is this small beside the largest define no sphere.
constexpr double dependent = 1.5e-8;

/// The state of Welzl's recursion: points that must lie on the surface, and the sphere they define.
class Support {
 public:
  explicit Support(const std::vector<Vector3d>& points) : points_(points) {}

  const MinimalSphere& sphere() const { return sphere_; }
  std::uint32_t size() const { return sphere_.basis_size; }

  /// The support with one more point: the smallest sphere through all of them.
  /// @return false if the points are affinely dependent; the sphere is unchanged then
  bool with(std::uint32_t index, Support& larger) const {
    larger.sphere_.basis = sphere_.basis;
    larger.sphere_.basis[size()] = index;
    larger.sphere_.basis_size = size() + 1;
    return larger.circumscribe();
  }

 private:
  /// Center = p0 + c with c in the span of the edges qi = pi − p0 and 2 qi·c = |qi|². By the QR
  /// decomposition of the edges: Gram's matrix would square their condition number, and make a
  /// sphere through four points that are nearly in a plane too large by 1e-9 and more.
  bool circumscribe() {
    const Vector3d& p0 = points_[sphere_.basis[0]];
    const auto n = static_cast<Eigen::Index>(size()) - 1;
    using UpTo3 = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
    using VectorUpTo3 = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
    UpTo3 edges(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      edges.col(i) = points_[sphere_.basis[static_cast<std::size_t>(i) + 1]] - p0;
    }
    Vector3d offset = Vector3d::Zero();
    if (n > 0) {
      const double scale = edges.cwiseAbs().maxCoeff();
      if (!(scale > 0.0)) {
        return false;
      }
      edges /= scale;  // so that squares neither over- nor underflow
      Eigen::ColPivHouseholderQR<UpTo3> qr(edges);
      qr.setThreshold(dependent);
      if (qr.rank() < n) {
        return false;
      }
      const VectorUpTo3 half_squares =
          0.5 * (qr.colsPermutation().transpose() * edges.colwise().squaredNorm().transpose());
      VectorUpTo3 c = VectorUpTo3::Zero(3);
      c.head(n) = qr.matrixR().topLeftCorner(n, n).triangularView<Eigen::Upper>().transpose().solve(
          half_squares);
      c.applyOnTheLeft(qr.householderQ());
      offset = scale * c;
    }
    sphere_.center = p0 + offset;
    // By the farthest of the support: rounding must not leave one of them outside.
    sphere_.squared_radius = 0.0;
    for (std::uint32_t i = 0; i < size(); ++i) {
      sphere_.squared_radius = std::max(sphere_.squared_radius,
                                        (points_[sphere_.basis[i]] - sphere_.center).squaredNorm());
    }
    return true;
  }

  const std::vector<Vector3d>& points_;
  MinimalSphere sphere_;
};

/// The smallest sphere around order[0..count) that has the support on its surface. The recursion is
/// over the support: four deep at most.
MinimalSphere enclose(const std::vector<Vector3d>& points, std::vector<std::uint32_t>& order,
                      std::size_t count, const Support& support) {
  if (support.size() == 4) {
    return support.sphere();
  }
  MinimalSphere best = support.sphere();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = order[i];
    if ((points[index] - best.center).squaredNorm() <= best.squared_radius) {
      continue;
    }
    Support larger(points);
    if (!support.with(index, larger)) {
      continue;
    }
    best = enclose(points, order, i, larger);
    std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(i),
                order.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
  return best;
}

/// Shuffles: the same way for the same count, on every machine.
void shuffle(std::vector<std::uint32_t>& order) {
  std::minstd_rand draw;
  for (std::size_t left = order.size(); left > 1; --left) {
    std::swap(order[left - 1], order[draw() % left]);
  }
}

}  // namespace

MinimalSphere minimal_sphere(const std::vector<Vector3d>& points,
                             std::vector<std::uint32_t>& order) {
  shuffle(order);
  MinimalSphere sphere = enclose(points, order, order.size(), Support(points));
  // Rounding and dependent points may leave one outside by a little: the radius takes them in.
  for (const std::uint32_t index : order) {
    sphere.squared_radius =
        std::max(sphere.squared_radius, (points[index] - sphere.center).squaredNorm());
  }
  return sphere;
}

}  // namespace fiber
