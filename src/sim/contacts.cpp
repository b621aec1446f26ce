#include "fiber_proximity/sim/contacts.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// What nodes of an edge share in a point of it; nodes that are held have no share.
Vector2d weights_of(const Rods& rods, std::uint32_t edge, double parameter) {
  const auto is_held = [&rods](std::uint32_t node) {
    return std::binary_search(rods.held.begin(), rods.held.end(), HeldNode{node, {}},
                              [](const HeldNode& a, const HeldNode& b) { return a.node < b.node; });
  };
  return {is_held(edge) ? 0.0 : 1.0 - parameter, is_held(edge + 1) ? 0.0 : parameter};
}

/// Adds one side of a contact to the rod it is on.
/// @param node of the rod, where the edge begins
void add_side(std::uint32_t node, const Vector2d& weights, const Vector3d& gradient,
              const Matrix3d& hessian, RodSystem& system) {
  system.add_gradient(node, weights[0] * gradient);
  system.add_gradient(node + 1, weights[1] * gradient);
  system.add_hessian(node, weights[0] * weights[0] * hessian);
  system.add_hessian(node + 1, weights[1] * weights[1] * hessian);
  system.add_hessian(node + 1, node, weights[0] * weights[1] * hessian);
}

void require_finite(const std::vector<Vector3d>& displacements) {
  const auto bad = std::find_if_not(displacements.begin(), displacements.end(),
                                    [](const Vector3d& v) { return v.allFinite(); });
  if (bad != displacements.end()) {
    throw std::runtime_error("the step diverges: the displacement of node " +
                             std::to_string(bad - displacements.begin()) + " is not finite");
  }
}

}  // namespace

Contacts::Contacts(std::vector<std::unique_ptr<ContactSource>> sources,
                   std::unique_ptr<Friction> friction)
    : sources_(std::move(sources)), friction_(std::move(friction)), found_by_(sources_.size()) {}

/// In parallel: sources do not know of each other.
template <class Function>
void Contacts::for_each_source(const Function& function) {
  tbb::parallel_for(std::size_t{0}, sources_.size(), function);
}

void Contacts::begin_step(const Rods& rods, const TimeStep& step) {
  for_each_source([&](std::size_t source) { sources_[source]->begin_step(rods, step); });
  if (friction_ != nullptr) {
    friction_->begin_step(rods, step);
  }
  islands_.reset(rods.count());
}

void Contacts::measure(const Rods& rods, std::vector<double>& energies) {
  for_each_source([&](std::size_t source) {
    sources_[source]->measure(rods);
    found_by_[source].clear();
    sources_[source]->find(rods, found_by_[source]);
  });
  found_.clear();
  for (const std::vector<ContactPoint>& found : found_by_) {
    found_.insert(found_.end(), found.begin(), found.end());
  }
  set_springs(found_, rods, energies);
  add_friction(rods, energies);
}

void Contacts::join(const Rods& rods, const std::vector<Vector3d>& displacements) {
  for (const std::unique_ptr<ContactSource>& source : sources_) {
    source->join(rods, displacements, islands_);
  }
}

void Contacts::join_found() {
  for (const ContactPoint& point : found_) {
    if (!point.is_obstacle()) {
      islands_.join(point.rod_a, point.rod_b);
    }
  }
}

void Contacts::accept(const std::vector<bool>& of_rods) {
  const auto is_accepted = [&](const ContactPoint& point) { return of_rods[point.rod_a]; };
  points_.erase(std::remove_if(points_.begin(), points_.end(), is_accepted), points_.end());
  std::copy_if(found_.begin(), found_.end(), std::back_inserter(points_), is_accepted);
}

void Contacts::energies(const Rods& rods, std::vector<double>& energies) const {
  stored_energies(rods, energies);
  add_friction(rods, energies);
}

void Contacts::stored_energies(const Rods& rods, std::vector<double>& energies) const {
  set_springs(points_, rods, energies);
}

void Contacts::set_springs(const std::vector<ContactPoint>& points, const Rods& rods,
                           std::vector<double>& energies) {
  energies.assign(rods.count(), 0.0);
  for (const ContactPoint& point : points) {
    energies[point.rod_a] += 0.5 * point.stiffness * point.depth * point.depth;
  }
}

void Contacts::add_friction(const Rods& rods, std::vector<double>& energies) const {
  if (friction_ == nullptr) {
    return;
  }
  for (const ContactPoint& point : points_) {
    energies[point.rod_a] += friction_->energy(point, friction_->slip(rods, point));
  }
}

void Contacts::add_derivatives(const Rods& rods, const std::vector<RodSystem*>& systems) {
  terms_.clear();
  for (const ContactPoint& point : points_) {
    Vector3d gradient = -point.stiffness * point.depth * point.normal;
    const Matrix3d along = point.normal * point.normal.transpose();
    Matrix3d hessian = point.stiffness * along;
    if (friction_ != nullptr) {
      const Vector3d slip = friction_->slip(rods, point);
      const double resistance = friction_->resistance(point, slip);
      gradient += resistance * slip;
      hessian += resistance * (Matrix3d::Identity() - along);
    }
    Term term{point.edge_a, point.edge_b, weights_of(rods, point.edge_a, point.s), Vector2d::Zero(),
              hessian};
    add_side(point.edge_a - rods.first(point.rod_a), term.weights_a, gradient, hessian,
             *systems[point.rod_a]);
    if (!point.is_obstacle()) {
      term.weights_b = weights_of(rods, point.edge_b, point.t);
      add_side(point.edge_b - rods.first(point.rod_b), term.weights_b, -gradient, hessian,
               *systems[point.rod_b]);
      terms_.push_back(term);
    }
  }
}

bool Contacts::has_coupling() const { return !terms_.empty(); }

void Contacts::add_coupling(const std::vector<std::size_t>& places, const double* displacements,
                            double* product) const {
  using Stride = Eigen::InnerStride<lane_count>;
  const auto displacement = [&](std::uint32_t node) {
    return Eigen::Map<const Vector3d, 0, Stride>(displacements + places[node]);
  };
  const auto combine = [&](std::uint32_t node, const Vector2d& weights) -> Vector3d {
    return weights[0] * displacement(node) + weights[1] * displacement(node + 1);
  };
  const auto spread = [&](std::uint32_t node, const Vector2d& weights, const Vector3d& v) {
    for (std::uint32_t end = 0; end < 2; ++end) {
      Eigen::Map<Vector3d, 0, Stride>(product + places[node + end]) -= weights[end] * v;
    }
  };
  for (const Term& term : terms_) {
    const Vector3d from_a = term.hessian * combine(term.node_a, term.weights_a);
    const Vector3d from_b = term.hessian * combine(term.node_b, term.weights_b);
    spread(term.node_a, term.weights_a, from_b);
    spread(term.node_b, term.weights_b, from_a);
  }
}

void Contacts::limit(const Rods& rods, std::vector<Vector3d>& displacements,
                     ContactSource::Way way) {
  std::vector<Vector3d> before;
  int round = 0;
  do {
    require_finite(displacements);  // else they would never be the same as before
    before = displacements;
    for (const std::unique_ptr<ContactSource>& source : sources_) {
      source->limit(rods, displacements, way, round);
    }
    ++round;
  } while (sources_.size() > 1 && displacements != before);
  if (way == ContactSource::Way::SHARES) {
    join(rods, displacements);
  }
}

}  // namespace fiber
