// What a group does about rods that a step leaves with more energy than they can have.

#include <algorithm>
#include <cmath>

#include "rod_group.hpp"

namespace fiber {

using Eigen::Vector3d;

/// Takes the energy that rods have in excess of what they may from their velocities; where these
/// have not so much, from where they are. A step of implicit Euler gains energy where a potential
/// is far from convex on the way, as where an edge shrinks to nothing and comes out on the other
/// side of its clamp, and where no step is found and rods are carried on by their momentum.
void RodGroup::take_gains(Rods& rods, const Effects& effects) {
  constexpr int most_halvings = 6;
  weigh_gains(rods);
  if (is_any_beyond()) {
    aim_back(rods);
    double share = 0.5;
    for (int i = 1; is_any_beyond() && i <= most_halvings; ++i) {
      go_back(rods, effects, i < most_halvings ? share : 1.0);
      weigh_gains(rods);
      share = 0.5 + 0.5 * share;
    }
  }
  for (const Search& search : searches_) {
    if (search.gained > 0.0) {
      slow_down(rods, search);
    }
  }
}

/// How much rods have gained, and could lose by being slower.
void RodGroup::weigh_gains(const Rods& rods) {
  for (Search& search : searches_) {
    search.gained = -search.accepted.unseen();
  }
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    const Lanes gains = batches_[batch].gains();
    for (std::size_t lane = 0; lane < batches_[batch].used(); ++lane) {
      search_of(batch, lane).gained += gains[lane];
    }
  }
  if (contacts_ != nullptr) {
    contacts_->stored_energies(rods, contact_energies_);
    for (std::uint32_t rod = 0; rod < searches_.size(); ++rod) {
      searches_[contacts_->islands().of(rod)].gained +=
          contact_energies_[rod] - allowed_contacts_[rod];
    }
  }
  for (Search& search : searches_) {
    search.is_beyond = false;
    if (search.gained > 0.0) {
      const Motion motion = motion_of(rods, search);
      search.is_beyond = search.gained > motion.common + motion.relative;
    }
  }
}

bool RodGroup::is_any_beyond() const {
  return std::any_of(searches_.begin(), searches_.end(),
                     [](const Search& search) { return search.is_beyond; });
}

/// The motion of what is not held.
RodGroup::Motion RodGroup::motion_of(const Rods& rods, const Search& search) {
  Motion motion;
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    if (&search_of(batch, lane) != &search) {
      return;
    }
    const std::vector<std::uint32_t>& held = batches_[batch].held(lane);
    const std::uint32_t rod = batches_[batch].rod(lane);
    for (std::uint32_t node = rods.first(rod); node < rods.end(rod); ++node) {
      if (!std::binary_search(held.begin(), held.end(), node - rods.first(rod))) {
        motion.nodes.push_back(node);
      }
      if (!rods.spins.empty()) {
        const double inertia = rods.sections[rod].inertia_per_length * rods.rest_lengths[node];
        motion.relative += 0.5 * inertia * rods.spins[node] * rods.spins[node];
      }
    }
  });
  double mass = 0.0;
  Vector3d momentum = Vector3d::Zero();
  for (const std::uint32_t node : motion.nodes) {
    mass += rods.masses[node];
    momentum += rods.masses[node] * rods.velocities[node];
  }
  if (mass > 0.0) {
    motion.velocity = momentum / mass;
    motion.common = 0.5 * mass * motion.velocity.squaredNorm();
  }
  for (const std::uint32_t node : motion.nodes) {
    motion.relative +=
        0.5 * rods.masses[node] * (rods.velocities[node] - motion.velocity).squaredNorm();
  }
  return motion;
}

/// They keep their momentum as long as they can.
void RodGroup::slow_down(Rods& rods, const Search& search) {
  const auto share_left = [](double lost, double energy) {
    return lost <= 0.0 ? 1.0 : lost < energy ? std::sqrt(1.0 - lost / energy) : 0.0;
  };
  const Motion motion = motion_of(rods, search);
  const double of_relative = share_left(search.gained, motion.relative);
  const double of_common = share_left(search.gained - motion.relative, motion.common);
  for (const std::uint32_t node : motion.nodes) {
    const Vector3d relative = rods.velocities[node] - motion.velocity;
    rods.velocities[node] = of_common * motion.velocity + of_relative * relative;
  }
  if (rods.spins.empty()) {
    return;
  }
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    const std::uint32_t rod = batches_[batch].rod(lane);
    if (&search_of(batch, lane) == &search) {
      std::for_each(rods.spins.begin() + rods.first(rod), rods.spins.begin() + rods.end(rod),
                    [&](double& spin) { spin *= of_relative; });
    }
  });
}

/// Makes steps that lead rods which have gained too much to where they began. An island that goes
/// back as a whole does not pass through itself: at both ends of its straight way, all is on its
/// sides of the planes between them. What it may meet on it goes back as well.
void RodGroup::aim_back(Rods& rods) {
  for (RodBatch& batch : batches_) {
    batch.remember();
  }
  std::vector<LaneFlags> go_back(batches_.size());
  std::vector<LaneFlags> before;
  do {
    before = go_back;
    for_each_rod([&](std::size_t batch, std::size_t lane) {
      go_back[batch][lane] = search_of(batch, lane).is_beyond;
    });
    for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
      batches_[batch].way_back(go_back[batch], part(step_, batch));
    }
    if (contacts_ != nullptr) {
      contacts_->measure(rods, contact_energies_);
      take_displacements();
      contacts_->join(rods, displacements_);
      join_searches();
    }
  } while (go_back != before);
  for (Search& search : searches_) {
    search.share = 0.0;
  }
}

/// Goes shares of these steps with those that have still gained too much.
void RodGroup::go_back(Rods& rods, const Effects& effects, double share) {
  for (Search& search : searches_) {
    search.share = search.is_beyond ? share : search.share;
    search.is_accepting = search.is_beyond;
  }
  move();
  measure(rods, effects);
  accept();
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].finish(rods); });
}

}  // namespace fiber
