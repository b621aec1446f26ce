// What contacts add to a group of rods: equations that join them, and ways that end where others
// are.

#include <algorithm>
#include <cmath>

#include "rod_group.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

using Numbers = Eigen::Map<Eigen::VectorXd>;

Numbers numbers(std::vector<Lanes>& values) {
  return {values.data()->of.data(), static_cast<Eigen::Index>(values.size() * lane_count)};
}

}  // namespace

void RodGroup::prepare_coupling(const Rods& rods) {
  for (auto* array : {&gradients_.residual, &gradients_.preconditioned, &gradients_.direction,
                      &gradients_.product, &gradients_.image}) {
    array->resize(step_.size());
  }
  systems_.resize(rods.count());
  places_.resize(rods.positions.size());
  displacements_.resize(rods.positions.size());
  const std::size_t unknowns = rods.angles.empty() ? 3 : 4;
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    const std::uint32_t rod = batches_[batch].rod(lane);
    systems_[rod] = &batches_[batch].system(lane);
    for (std::uint32_t i = 0; i < rods.node_count(rod); ++i) {
      places_[rods.first(rod) + i] = (offsets_[batch] + i * unknowns) * lane_count + lane;
    }
  });
}

/// From where the contacts were measured, the beginning: neither inertia nor what holds a rod may
/// carry it through another on its way from where it began.
void RodGroup::limit_start(Rods& rods, const Effects& effects) {
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].store(rods); });
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] = rods.positions[i] - beginning_[i];
  }
  rods.positions = beginning_;
  wanted_ = displacements_;
  contacts_->limit(rods, displacements_);
  for_each_batch(Work::MUCH, [&](std::size_t batch) { stop_torn(rods, effects, batch); });
  rods.positions = beginning_;
  // What stays may be in the way of what follows it.
  contacts_->limit(rods, displacements_);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    rods.positions[i] += displacements_[i];
  }
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].place(rods.positions); });
}

/// Where limits have stopped nodes of a rod so that their neighbours are torn from them, only what
/// is held moves: the rod has no more energy than it began with.
void RodGroup::stop_torn(Rods& rods, const Effects& effects, std::size_t index) {
  RodBatch& batch = batches_[index];
  LaneFlags is_limited{};
  for (std::size_t lane = 0; lane < batch.used(); ++lane) {
    const auto first = static_cast<std::ptrdiff_t>(rods.first(batch.rod(lane)));
    const auto end = static_cast<std::ptrdiff_t>(rods.end(batch.rod(lane)));
    is_limited[lane] =
        !std::equal(wanted_.begin() + first, wanted_.begin() + end, displacements_.begin() + first);
  }
  if (std::none_of(is_limited.begin(), is_limited.end(), [](bool is) { return is; })) {
    return;
  }
  const auto merits_after = [&](const std::vector<Vector3d>& displacements) {
    std::vector<Vector3d> positions = beginning_;
    for (std::size_t lane = 0; lane < batch.used(); ++lane) {
      const std::uint32_t rod = batch.rod(lane);
      for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
        positions[i] += displacements[i];
      }
    }
    batch.place(positions);
    batch.store_for(effects, rods);
    batch.measure(rods, effects);
    std::array<double, lane_count> merits{};
    for (std::size_t lane = 0; lane < batch.used(); ++lane) {
      merits[lane] = batch.merit(lane).energy;
    }
    return merits;
  };
  std::vector<Vector3d> stopped(displacements_.size(), Vector3d::Zero());
  for (std::size_t lane = 0; lane < batch.used(); ++lane) {
    for (const std::uint32_t node : batch.held(lane)) {
      const std::uint32_t held = rods.first(batch.rod(lane)) + node;
      stopped[held] = displacements_[held];
    }
  }
  const std::array<double, lane_count> limited = merits_after(displacements_);
  const std::array<double, lane_count> at_rest = merits_after(stopped);
  for (std::size_t lane = 0; lane < batch.used(); ++lane) {
    if (is_limited[lane] && limited[lane] > at_rest[lane]) {
      const std::uint32_t rod = batch.rod(lane);
      std::copy(stopped.begin() + rods.first(rod), stopped.begin() + rods.end(rod),
                displacements_.begin() + rods.first(rod));
    }
  }
}

/// Conjugate gradients for what joins rods, from the step without it, with the factors of the rods
/// as preconditioner. The Hessian's product with a direction p needs no Hessian: with the
/// preconditioner M, M p follows from the residuals p is made of.
void RodGroup::correct_step() {
  constexpr int most_iterations = 100;
  constexpr double tolerance = 1e-3;  // of the residual, in the preconditioner's norm
  const auto add_coupling = [this](const Numbers& values, Numbers& product) {
    contacts_->add_coupling(places_, values.data(), product.data());
  };
  // Few rods are solved for sooner than threads are told to.
  const auto precondition = [this](std::vector<Lanes>& values) {
    for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
      batches_[batch].solve(part(values, batch));
    }
  };
  Numbers step = numbers(step_);
  Numbers residual = numbers(gradients_.residual);
  Numbers preconditioned = numbers(gradients_.preconditioned);
  Numbers direction = numbers(gradients_.direction);
  Numbers product = numbers(gradients_.product);
  Numbers image = numbers(gradients_.image);
  image = -step;
  residual.setZero();
  add_coupling(image, residual);
  direction = residual;
  precondition(gradients_.direction);
  product = residual;
  double norm = residual.dot(direction);
  const double small = tolerance * tolerance * searches_.front().decrease;
  for (int i = 0; i < most_iterations && norm > small; ++i) {
    image = product;
    add_coupling(direction, image);
    const double curvature = direction.dot(image);
    if (!(curvature > 0.0 && std::isfinite(curvature))) {
      break;
    }
    const double share = norm / curvature;
    step += share * direction;
    residual -= share * image;
    preconditioned = residual;
    precondition(gradients_.preconditioned);
    const double next_norm = residual.dot(preconditioned);
    direction = preconditioned + next_norm / norm * direction;
    product = residual + next_norm / norm * product;
    norm = next_norm;
  }
}

void RodGroup::limit_step(const Rods& rods) {
  using Stride = Eigen::InnerStride<lane_count>;
  double* const step = numbers(step_).data();
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] = Eigen::Map<const Vector3d, 0, Stride>(step + places_[i]);
  }
  contacts_->limit(rods, displacements_);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    Eigen::Map<Vector3d, 0, Stride>(step + places_[i]) = displacements_[i];
  }
}

}  // namespace fiber
