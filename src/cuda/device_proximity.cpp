#include "fiber_proximity/cuda/device_proximity.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "src/bounds/bounding_volume.hpp"
#include "src/cuda/device_fibers.hpp"

namespace fiber {

struct DeviceProximity::Tree {
  std::unique_ptr<DeviceTree> tree;
  std::vector<double> radii;  // by first point [m]
  HostFibers fibers;          // without coordinates
  bool has_points = false;
};

DeviceProximity::DeviceProximity(std::vector<std::uint32_t> offsets, std::vector<double> radii)
    : DeviceProximity(make_cuda_device(), std::move(offsets), std::move(radii)) {}

DeviceProximity::DeviceProximity(std::unique_ptr<Device> device, std::vector<std::uint32_t> offsets,
                                 std::vector<double> radii)
    : offsets_(std::move(offsets)), device_(std::move(device)), tree_(std::make_unique<Tree>()) {
  // It looks at the offsets and the radii; where the points are nobody knows yet.
  const std::size_t point_count = offsets_.empty() ? 0 : offsets_.back();
  const FiberAssembly fibers(std::vector<Eigen::Vector3d>(point_count, Eigen::Vector3d::Zero()),
                             offsets_, std::move(radii));
  require_tree_size(fibers.segment_count());
  tree_->fibers.point_count = point_count;
  tree_->fibers.radius = fibers.radii().front();
  if (fibers.radius_per() != RadiusPer::ASSEMBLY) {
    tree_->radii.resize(point_count);
    for (std::uint32_t point = 0; point < point_count; ++point) {
      tree_->radii[point] = fibers.segment_radius(point);
    }
    tree_->fibers.radii = tree_->radii.data();
  }
  tree_->tree = device_->make_tree();
  tree_->tree->set_topology(topology_of(offsets_));
}

DeviceProximity::~DeviceProximity() = default;

template <class Number>
void DeviceProximity::take(const Number* coordinates) {
  tree_->has_points = false;
  tree_->tree->update(tree_->fibers, coordinates);
  tree_->has_points = true;
}

void DeviceProximity::update(const double* coordinates) { take(coordinates); }
void DeviceProximity::update(const float* coordinates) { take(coordinates); }

DeviceProximity::Contacts DeviceProximity::query(const Options& options) const {
  if (!(options.margin >= 0.0 && std::isfinite(options.margin))) {
    throw std::invalid_argument("margin is " + std::to_string(options.margin) +
                                " m, it must be finite and not negative");
  }
  if (!tree_->has_points) {
    throw std::logic_error("there are no points yet: call update() first");
  }
  PairRule rule;
  rule.bound = round_up(options.margin);
  rule.neighbour_skip = options.neighbour_skip;
  rule.same_fiber = options.pairing != Pairing::DIFFERENT_FIBERS;
  rule.different_fibers = options.pairing != Pairing::SAME_FIBER;
  const DeviceContacts found = device_->contacts(*tree_->tree, rule, options.margin);
  const ContactArrays& arrays = found.arrays;
  return {found.count, arrays.a, arrays.b, arrays.s, arrays.t, arrays.distance};
}

double DeviceProximity::device_seconds() const {
  return tree_->tree->seconds() + device_->seconds();
}

}  // namespace fiber
