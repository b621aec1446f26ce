#include "fiber_proximity/query/crossings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/query/crossing_test.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double rounding = 0x1p-42;

/// value · 2^−exponent, so that the largest coordinate is about 1.
Vector3d scaled(const Vector3d& vector, int exponent) {
  return vector.unaryExpr([exponent](double value) { return std::ldexp(value, -exponent); });
}

int exponent_of(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return exponent;
}

class ParallelImage {
 public:
  ParallelImage(const std::vector<Vector3d>& points, const Vector3d& direction) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& point : points) {
      box.extend(point);
    }
    middle_ = 0.5 * box.min() + 0.5 * box.max();
    exponent_ = exponent_of(box.sizes().maxCoeff());
    const Vector3d along =
        scaled(direction, exponent_of(direction.cwiseAbs().maxCoeff())).normalized();
    right_ = along.unitOrthogonal();
    up_ = right_.cross(along);
  }

  Vector3d operator()(const Vector3d& point) const {
    const Vector3d offset = scaled(point - middle_, exponent_);
    return {right_.dot(offset), up_.dot(offset), 0.0};
  }

 private:
  Vector3d middle_;
  Vector3d right_;
  Vector3d up_;
  int exponent_;
};

/// Where the sphere around the eye is pierced; the origin for the eye itself.
Vector3d seen_from(const Vector3d& eye, const Vector3d& point) {
  const Vector3d offset = point - eye;
  const double largest = offset.cwiseAbs().maxCoeff();
  return largest > 0.0 ? scaled(offset, exponent_of(largest)).normalized() : Vector3d::Zero();
}

double radius_of_arc(const Vector3d& from, const Vector3d& to) {
  const bool ends_in_eye = from == Vector3d::Zero() || to == Vector3d::Zero();
  return rounding + (ends_in_eye ? 1.0 : 0.25 * (to - from).squaredNorm());
}

/// The fibres with other points, and a radius for each segment.
template <class Place, class Radius>
void make_image(const FiberAssembly& fibers, const Place& place, const Radius& radius,
                FiberAssembly& image) {
  std::vector<Vector3d> points;
  std::vector<double> radii(fibers.point_count(), 0.0);
  points.reserve(fibers.point_count());
  for (const Vector3d& point : fibers.points()) {
    points.push_back(place(point));
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      radii[i] = radius(points[i], points[i + 1]);
    }
  }
  image.assign_segments(points, fibers.offsets(), radii);
}

/// Fibres as a view shows them, for a broad phase: the capsules of two segments of the image touch
/// if the view shows a common point of the segments' axes. The view is valid.
///
/// Along parallel rays the image is in a plane, in units of the fibres' extent. Axes with a common
/// point have images with one; rounding moves a point of the image by less than 2^-46, and the
/// radius is 2^-42, which leaves enough for a kernel's error.
///
/// From an eye the image is on the unit sphere around it, so what is near the plane of the eye
/// needs no clipping. A segment is seen as an arc of a great circle, of angle θ, and its capsule is
/// that of the chord c. No point of the arc is further from the chord than 1 − cos(θ/2), which is
/// at most sin²(θ/2) = c²/4; the radius is that and 2^-42 for rounding. An end in the eye itself is
/// seen nowhere: such a segment has a capsule around all of the sphere.
/// @param image overwritten in the memory it has; of the same offsets
void make_view_image(const FiberAssembly& fibers, const View& view, FiberAssembly& image) {
  if (view.is_perspective) {
    const auto place = [&](const Vector3d& point) { return seen_from(view.eye, point); };
    make_image(fibers, place, radius_of_arc, image);
  } else {
    const auto radius = [](const Vector3d& /*from*/, const Vector3d& /*to*/) { return rounding; };
    make_image(fibers, ParallelImage(fibers.points(), view.direction), radius, image);
  }
}

}  // namespace

void validate(const View& view) {
  require_coordinates("direction of view", view.direction);
  if (view.direction == Eigen::Vector3d::Zero()) {
    throw std::invalid_argument("direction of view: is 0,0,0, it must have a length");
  }
  if (view.is_perspective) {
    require_coordinates("eye", view.eye);
  }
}

CrossingFinder::CrossingFinder(std::uint32_t threads)
    : engine_(make_engine("run_tree", EngineOptions{threads})) {}

void CrossingFinder::find(const FiberAssembly& fibers, const View& view,
                          std::vector<Crossing>& crossings) {
  validate(view);
  crossings.clear();
  make_view_image(fibers, view, image_);
  engine_->update(image_);
  QueryOptions options;
  options.neighbour_skip = 1;  // a loop seen from the side can be flat: crossings need none
  engine_->query(options, candidates_);
  const CrossingTest test(fibers, view);
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  for (const Contact& pair : candidates_.contacts) {
    // In the order of their keys, which crossings inherit.
    if (const std::optional<Crossing> crossing =
            test(offsets[pair.fiber_a] + pair.segment_a, offsets[pair.fiber_b] + pair.segment_b)) {
      crossings.push_back(*crossing);
    }
  }
}

std::vector<Crossing> find_crossings(const FiberAssembly& fibers, const View& view) {
  std::vector<Crossing> crossings;
  CrossingFinder().find(fibers, view, crossings);
  return crossings;
}

}  // namespace fiber
