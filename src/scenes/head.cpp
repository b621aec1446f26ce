#include "src/scenes/head.hpp"

#include "src/scenes/portable_math.hpp"

namespace fiber {

double Head::level(const Eigen::Vector3d& point) {
  const Eigen::Vector3d image = to_sphere(point);
  return std::sqrt(dot(image, image));
}

Eigen::Vector3d Head::lifted(const Eigen::Vector3d& point, double least_level) {
  const double current = level(point);
  return current < least_level ? Eigen::Vector3d(point * (least_level / current)) : point;
}

Eigen::Vector3d Head::normal(const Eigen::Vector3d& point) {
  return unit(to_sphere(to_sphere(point)));
}

}  // namespace fiber
