#include "rod_group.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace fiber {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Merit sum_of(const std::vector<Merit>& merits) {
  Merit sum;
  for (const Merit& merit : merits) {
    sum.add(merit);
  }
  return sum;
}

}  // namespace

RodGroup::RodGroup(const Rods& rods, std::uint32_t begin, std::uint32_t end, Contacts* contacts)
    : contacts_(contacts),
      first_node_(rods.first(begin)),
      unknowns_(rods.angles.empty() ? 3 : 4),
      merits_(end - begin),
      accepted_merits_(end - begin),
      is_lost_(end - begin) {
  rods_.reserve(end - begin);
  for (std::uint32_t rod = begin; rod < end; ++rod) {
    rods_.emplace_back(rods, rod);
    systems_.push_back(&rods_.back().system());
    offsets_.push_back(std::size_t{rods.first(rod) - first_node_} * unknowns_);
  }
  const std::size_t count = std::size_t{rods.first(end) - first_node_} * unknowns_;
  gradient_.resize(static_cast<Eigen::Index>(count));
  step_.resize(gradient_.size());
}

template <typename Function>
void RodGroup::for_each_rod(const Function& function) {
  if (rods_.size() == 1) {
    function(0);
  } else {
    tbb::parallel_for(std::size_t{0}, rods_.size(), function);
  }
}

double* RodGroup::part(VectorXd& values, std::size_t rod) const {
  return values.data() + offsets_[rod];
}

void RodGroup::solve(Rods& rods, const Effects& effects, const StepperOptions& options,
                     double step) {
  for_each_rod([&](std::size_t rod) { rods_[rod].begin(rods, step); });
  limit_start(rods, effects);
  iterate(rods, effects, options);
  if (find_lost(rods, effects)) {
    for_each_rod([&](std::size_t rod) {
      if (is_lost_[rod] != 0) {
        rods_[rod].carry(rods);
      } else {
        rods_[rod].predict(rods);
      }
    });
    limit_start(rods, effects);
    iterate(rods, effects, options);
  }
  for_each_rod([&](std::size_t rod) { rods_[rod].finish(rods); });
}

/// Finds rods that inertia has thrown where few iterations do not lead back from, as it does with
/// something stiff: to keep their shapes is nearer to what they do.
/// @returns true if there are any
bool RodGroup::find_lost(Rods& rods, const Effects& effects) {
  for_each_rod([&](std::size_t rod) {
    const double found = accepted_merits_[rod].energy;
    rods_[rod].store(rods);
    rods_[rod].carry(rods);
    const Merit carried = rods_[rod].merit(rods, effects);
    rods_[rod].restore(rods);
    is_lost_[rod] = found > carried.energy + carried.unseen() ? 1 : 0;
  });
  return std::find(is_lost_.begin(), is_lost_.end(), 1) != is_lost_.end();
}

/// Newton's method from where the rods are.
void RodGroup::iterate(Rods& rods, const Effects& effects, const StepperOptions& options) {
  measure(rods, effects);
  accept();
  for (std::uint32_t iteration = 0; iteration < options.iterations; ++iteration) {
    find_step(rods, effects);
    const bool is_last = step_.cwiseAbs().maxCoeff() < options.tolerance;
    if (!search(rods, effects) || is_last) {
      break;
    }
  }
}

/// Neither inertia nor what holds a rod may carry it through another on its way from where it
/// began.
void RodGroup::limit_start(Rods& rods, const Effects& effects) {
  if (contacts_ == nullptr) {
    return;
  }
  displacements_ = rods.positions;
  for (std::size_t rod = 0; rod < rods_.size(); ++rod) {
    std::copy(rods_[rod].beginning().begin(), rods_[rod].beginning().end(),
              rods.positions.begin() + rods.first(static_cast<std::uint32_t>(rod)));
  }
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] -= rods.positions[i];
  }
  const std::vector<Vector3d> wanted = displacements_;
  contacts_->measure(rods);
  contacts_->limit(rods, displacements_);
  for_each_rod([&](std::size_t rod) { stop_torn(rods, effects, rod, wanted); });
  // What stays may be in the way of what follows it.
  contacts_->limit(rods, displacements_);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    rods.positions[i] += displacements_[i];
  }
}

/// Where limits have stopped nodes of a rod so that their neighbours are torn from them, only what
/// is held moves: the rod has no more energy than it began with.
void RodGroup::stop_torn(Rods& rods, const Effects& effects, std::size_t rod,
                         const std::vector<Vector3d>& wanted) {
  const std::uint32_t first = rods.first(static_cast<std::uint32_t>(rod));
  const std::uint32_t end = rods.end(static_cast<std::uint32_t>(rod));
  if (std::equal(wanted.begin() + first, wanted.begin() + end, displacements_.begin() + first)) {
    return;
  }
  std::vector<Vector3d> stopped(end - first, Vector3d::Zero());
  for (const std::uint32_t node : rods_[rod].held()) {
    stopped[node] = displacements_[first + node];
  }
  rods_[rod].store(rods);
  const auto merit_after = [&](const Vector3d* displacements) {
    for (std::uint32_t i = first; i < end; ++i) {
      rods.positions[i] += displacements[i - first];
    }
    const double merit = rods_[rod].merit(rods, effects).energy;
    rods_[rod].restore(rods);
    return merit;
  };
  if (merit_after(&displacements_[first]) > merit_after(stopped.data())) {
    std::copy(stopped.begin(), stopped.end(), displacements_.begin() + first);
  }
}

/// The merit of where the rods are now, with the contacts there.
Merit RodGroup::measure(const Rods& rods, const Effects& effects) {
  for_each_rod([&](std::size_t rod) { merits_[rod] = rods_[rod].merit(rods, effects); });
  Merit merit = sum_of(merits_);
  if (contacts_ != nullptr) {
    merit.add(contacts_->measure(rods));
  }
  return merit;
}

/// The same of where the rods and contacts were accepted; the friction is that of these contacts.
Merit RodGroup::accepted_merit(const Rods& rods) const {
  Merit merit = sum_of(accepted_merits_);
  if (contacts_ != nullptr) {
    merit.add(contacts_->energy(rods));
  }
  return merit;
}

/// Accepts where the rods were measured.
void RodGroup::accept() {
  accepted_merits_.swap(merits_);
  if (contacts_ != nullptr) {
    contacts_->accept();
  }
}

void RodGroup::find_step(const Rods& rods, const Effects& effects) {
  for_each_rod([&](std::size_t rod) { rods_[rod].assemble(rods, effects); });
  if (contacts_ != nullptr) {
    contacts_->add_derivatives(rods, systems_);
  }
  for_each_rod([&](std::size_t rod) {
    rods_[rod].factorise();
    const std::vector<double>& gradient = systems_[rod]->gradient();
    std::copy(gradient.begin(), gradient.end(), part(gradient_, rod));
  });
  step_ = -gradient_;
  precondition(step_);
  if (contacts_ != nullptr) {
    if (contacts_->has_coupling()) {
      correct_step();
    }
    limit_step(rods);
  }
}

void RodGroup::precondition(VectorXd& values) {
  for_each_rod([&](std::size_t rod) { systems_[rod]->solve(part(values, rod)); });
}

/// Conjugate gradients for what joins rods, from the step without it, with the factors of the rods
/// as preconditioner. The Hessian's product with a direction p needs no Hessian: with the
/// preconditioner M, M p follows from the residuals p is made of.
void RodGroup::correct_step() {
  constexpr int most_iterations = 100;
  constexpr double tolerance = 1e-3;  // of the residual, in the preconditioner's norm
  const auto add_coupling = [this](const VectorXd& values, VectorXd& product) {
    contacts_->add_coupling(values, unknowns_, product);
  };
  VectorXd residual = VectorXd::Zero(step_.size());
  add_coupling(-step_, residual);
  VectorXd direction = residual;
  precondition(direction);
  VectorXd preconditioned = direction;
  VectorXd product = residual;  // of the preconditioner and the direction
  VectorXd image(step_.size());
  double norm = residual.dot(preconditioned);
  const double small = tolerance * tolerance * -gradient_.dot(step_);
  for (int i = 0; i < most_iterations && norm > small; ++i) {
    image = product;
    add_coupling(direction, image);
    const double share = norm / direction.dot(image);
    step_ += share * direction;
    residual -= share * image;
    preconditioned = residual;
    precondition(preconditioned);
    const double next_norm = residual.dot(preconditioned);
    direction = preconditioned + next_norm / norm * direction;
    product = residual + next_norm / norm * product;
    norm = next_norm;
  }
}

void RodGroup::limit_step(const Rods& rods) {
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] = step_.segment<3>(static_cast<Eigen::Index>(i * unknowns_));
  }
  contacts_->limit(rods, displacements_);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    step_.segment<3>(static_cast<Eigen::Index>(i * unknowns_)) = displacements_[i];
  }
}

bool RodGroup::search(Rods& rods, const Effects& effects) {
  // A step must bring at least this part of the decrease that its slope promises (Armijo).
  constexpr double sufficient = 1e-4;
  constexpr int most_halvings = 20;
  for_each_rod([&](std::size_t rod) { rods_[rod].store(rods); });
  const auto move = [&](double share) {
    for_each_rod([&](std::size_t rod) { rods_[rod].move(rods, part(step_, rod), share); });
  };
  const Merit before = accepted_merit(rods);
  const double decrease = std::max(0.0, -gradient_.dot(step_));
  double share = 1.0;
  for (int i = 0; i < most_halvings; ++i, share *= 0.5) {
    move(share);
    const double wanted = before.energy - sufficient * share * decrease + before.unseen();
    if (measure(rods, effects).energy <= wanted) {
      accept();
      return true;
    }
  }
  // Nothing is left to gain, or the rods are where no step of this direction helps.
  move(0.0);
  return false;
}

}  // namespace fiber
