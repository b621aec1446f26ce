#include "fiber_proximity/cuda/device_proximity.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "src/cuda/device_fibers.hpp"
#include "src/cuda/device_proximity_tree.hpp"

namespace fiber {
namespace {

const double* coordinates_of(const std::vector<Eigen::Vector3d>& points) {
  return points.empty() ? nullptr : points.front().data();
}

DeviceProximity::Contacts contacts_of(const DeviceContacts& found) {
  const ContactArrays& arrays = found.arrays;
  return {
      found.count, arrays.a, arrays.b, arrays.s, arrays.t, arrays.distance, found.candidate_begins,
      found.memory};
}

}  // namespace

DeviceProximity::DeviceProximity(std::vector<std::uint32_t> offsets, std::vector<double> radii)
    : DeviceProximity(make_cuda_device(), std::move(offsets), std::move(radii)) {}

DeviceProximity::DeviceProximity(std::vector<std::uint32_t> offsets, std::vector<double> radii,
                                 std::vector<std::uint32_t> candidates)
    : DeviceProximity(make_cuda_device(), std::move(offsets), std::move(radii),
                      std::move(candidates)) {}

DeviceProximity::DeviceProximity(std::unique_ptr<Device> device, std::vector<std::uint32_t> offsets,
                                 std::vector<double> radii)
    : offsets_(std::move(offsets)), device_(std::move(device)), tree_(std::make_unique<Tree>()) {
  take_topology(std::move(radii), nullptr);
}

DeviceProximity::DeviceProximity(std::unique_ptr<Device> device, std::vector<std::uint32_t> offsets,
                                 std::vector<double> radii, std::vector<std::uint32_t> candidates)
    : offsets_(std::move(offsets)), device_(std::move(device)), tree_(std::make_unique<Tree>()) {
  take_topology(std::move(radii), &candidates);
}

/// @param candidates null where there are none
void DeviceProximity::take_topology(std::vector<double> radii,
                                    std::vector<std::uint32_t>* candidates) {
  // It looks at the offsets and the radii; where the points are nobody knows yet.
  const std::size_t point_count = offsets_.empty() ? 0 : offsets_.back();
  require_tree_size(point_count - std::min(point_count, offsets_.size()));  // at least so many
  const FiberAssembly fibers(std::vector<Eigen::Vector3d>(point_count, Eigen::Vector3d::Zero()),
                             offsets_, std::move(radii));
  require_tree_size(fibers.segment_count());
  HostTopology topology = topology_of(offsets_);
  tree_->fibers = host_fibers(fibers, tree_->radii);
  tree_->radius_per = fibers.radius_per();
  if (candidates != nullptr) {
    require_candidates(*candidates, fibers.fiber_count());
    add_candidates(offsets_, *candidates, topology);
    tree_->given_radii = fibers.radii();
    tree_->candidates = std::move(*candidates);
    tree_->candidate_points = topology.candidate_points;
    tree_->fibers.candidate_points = &tree_->candidate_points;
  }
  tree_->tree = device_->make_tree();
  tree_->tree->set_topology(topology);
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

/// @throws std::invalid_argument
void DeviceProximity::require_count(const std::vector<Eigen::Vector3d>& points) const {
  if (points.size() != point_count()) {
    throw std::invalid_argument("there are " + std::to_string(points.size()) +
                                " points, the fibres have " + std::to_string(point_count()));
  }
}

void DeviceProximity::update_from_host(const std::vector<Eigen::Vector3d>& points) {
  require_count(points);
  update_from_host(coordinates_of(points));
}

void DeviceProximity::update_from_host(const double* coordinates) {
  if (coordinates == nullptr && point_count() > 0) {
    throw std::invalid_argument("the points are a null pointer, the fibres have " +
                                std::to_string(point_count()));
  }
  tree_->has_points = false;
  HostFibers fibers = tree_->fibers;
  fibers.coordinates = coordinates;
  tree_->tree->update(fibers);
  tree_->has_points = true;
}

std::shared_ptr<void> DeviceProximity::lock_points(
    const std::vector<Eigen::Vector3d>& points) const {
  require_count(points);
  return lock_points(coordinates_of(points));
}

std::shared_ptr<void> DeviceProximity::lock_points(const double* coordinates) const {
  if (point_count() == 0) {
    return nullptr;
  }
  return device_->lock_pages(coordinates, point_count() * sizeof(Eigen::Vector3d));
}

void DeviceProximity::copy_to_host(const Contacts& contacts, HostContacts& copy) const {
  const auto read = [&](const auto* from, auto& to) {
    to.resize(contacts.count);
    device_->read(from, contacts.count * sizeof(*from), to.data());
  };
  read(contacts.a, copy.a);
  read(contacts.b, copy.b);
  read(contacts.s, copy.s);
  read(contacts.t, copy.t);
  read(contacts.distance, copy.distance);
  copy.candidate_begins.resize(contacts.candidate_begins != nullptr ? candidate_count() + 1 : 0);
  if (contacts.candidate_begins != nullptr) {
    device_->read(contacts.candidate_begins, copy.candidate_begins.size() * sizeof(std::uint32_t),
                  copy.candidate_begins.data());
  }
}

std::size_t DeviceProximity::candidate_count() const {
  return tree_->candidates.empty() ? 0 : tree_->candidates.size() - 1;
}

/// @throws as query()
PairRule DeviceProximity::rule_of(const Options& options) const {
  if (!(options.margin >= 0.0 && std::isfinite(options.margin))) {
    throw std::invalid_argument("margin is " + std::to_string(options.margin) +
                                " m, it must be finite and not negative");
  }
  if (!tree_->has_points) {
    throw std::logic_error("there are no points yet: call update() first");
  }
  PairRule rule = pair_rule(options.margin, options.neighbour_skip.value_or(1), options.pairing);
  rule.with_itself = options.with_itself;
  return rule;
}

/// @throws as query()
PairRule DeviceProximity::rule_of_contacts(const Options& options) const {
  if (!options.neighbour_skip) {
    throw std::invalid_argument(
        "neighbour_skip has no value, contacts on the device need one: the rule of loops is asked "
        "by check_candidates() alone");
  }
  return rule_of(options);
}

DeviceProximity::Contacts DeviceProximity::query(const Options& options) const {
  return contacts_of(device_->contacts(*tree_->tree, rule_of_contacts(options), options.margin));
}

DeviceProximity::Contacts DeviceProximity::query_to_host(const Options& options) const {
  return contacts_of(
      device_->contacts_to_host(*tree_->tree, rule_of_contacts(options), options.margin));
}

std::optional<int> DeviceProximity::gpu() const { return device_->gpu(); }

std::vector<DeviceProximity::Stage> DeviceProximity::device_stages() const {
  std::vector<Stage> stages;
  for (const auto& some : {tree_->tree->stages(), device_->stages()}) {
    for (const DeviceStage& stage : some) {
      stages.push_back({stage.name, stage.seconds});
    }
  }
  return stages;
}

double DeviceProximity::device_seconds() const {
  return seconds_of(tree_->tree->stages()) + seconds_of(device_->stages());
}

}  // namespace fiber
