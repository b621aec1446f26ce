#include "src/sim/solver/stage_solver.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "src/query/threads.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Splits rods into as few packs as possible, of about the same size.
void add_packs(const std::vector<std::uint32_t>& rods,
               std::vector<std::vector<std::uint32_t>>& packs) {
  const std::size_t count = (rods.size() + lane_count - 1) / lane_count;
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(i * rods.size() / count);
    const auto end = static_cast<std::ptrdiff_t>((i + 1) * rods.size() / count);
    packs.emplace_back(rods.begin() + begin, rods.begin() + end);
  }
}

}  // namespace

StageSolver::StageSolver(const Rods& rods, const StepperOptions& options, Contacts* contacts,
                         Joints* joints)
    : options_(options),
      contacts_(contacts),
      joints_(joints),
      arena_(arena_concurrency(options.threads)) {
  if (joints_ != nullptr) {
    joint_clusters_ = joint_clusters(joints_->parts(), rods.count());
  }
  scratch_.resize(rods);
  group_of_.resize(rods.count());
  is_returning_.resize(rods.count());
  expect_pressed_contacts();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    travel_bound_.by_rod.push_back(StepBound::min_travel * rods.radii[rod]);
  }
  reset_islands(rods);
  make_groups(rods);
}

/// Rods that are joined are of one island.
void StageSolver::reset_islands(const Rods& rods) {
  islands_.reset(rods.count());
  if (joints_ != nullptr) {
    for (const std::vector<PlacedNode>& place : joints_->parts().places) {
      for (const PlacedNode& each : place) {
        islands_.join(place.front().rod, each.rod);
      }
    }
  }
}

void StageSolver::solve(Rods& rods, const Effects& effects, const TimeStep& stage,
                        const RodState* reference) {
  last_step_ = stage.length;
  is_at_start_ = has_start_rates_ = reference == nullptr;
  if (contacts_ != nullptr || reference != nullptr) {
    start_ = rods.state();
    if (reference != nullptr) {
      rods.state() = *reference;
    }
    reference_ = rods.state();
  }
  const RodState* const begin = stage.earlier.front().state;
  origins_ = {begin != nullptr ? begin : &start_, &anchors_};
  arena_.execute([&] {
    for (const auto& effect : effects) {
      effect->begin_step(rods, stage);
    }
    if (joints_ != nullptr) {
      joints_->begin_step(rods, stage);
    }
    for (Group& group : groups_) {
      group.is_solved = false;
    }
    travel_bound_.is_final = false;
    ObstacleMotions* const obstacles = contacts_ != nullptr ? contacts_->motions() : nullptr;
    if (contacts_ != nullptr) {
      predict_motion(reference_, stage.length);
    }
    if (obstacles != nullptr) {
      obstacles->begin_solve(stage.end());
    }
    std::uint32_t times_stuck = 0;
    bool is_solved = false;
    while (!is_solved) {
      if (contacts_ != nullptr) {
        find_contacts(rods);
        make_groups(rods);
        distribute_contacts();
      }
      tbb::parallel_for(std::size_t{0}, groups_.size(), [&](std::size_t index) {
        if (!groups_[index].is_solved) {
          solve_group(rods, effects, stage.length, groups_[index]);
        }
      });
      is_solved = std::all_of(groups_.begin(), groups_.end(),
                              [](const Group& group) { return group.is_solved; });
      if (!is_solved) {
        if (obstacles != nullptr) {
          times_stuck += shorten_obstacle_motions(times_stuck) ? 1 : 0;
        }
        widen_travel_bound(rods);
        is_at_start_ = false;
      }
    }
    if (obstacles != nullptr) {
      obstacles->end_solve();
    }
    if (contacts_ != nullptr) {
      if (travel_bound_.is_final) {  // widen_travel_bound() has cleared the expected displacements
        predict_motion(reference_, stage.length);
      }
      adapt_travel_bound(rods);
    }
  });
}

/// Finds the contacts that rods may come to from where the solve starts.
void StageSolver::find_contacts(Rods& rods) {
  rods.positions.swap(start_.positions);
  found_by_.resize(contacts_->sources().size());
  tbb::parallel_for(std::size_t{0}, found_by_.size(), [&](std::size_t source) {
    found_by_[source].clear();
    contacts_->sources()[source]->find(rods, travel_bound_, found_by_[source]);
  });
  rods.positions.swap(start_.positions);
  reset_islands(rods);
  for (const ContactSet& found : found_by_) {
    for (const EdgePair& pair : found.pairs) {
      islands_.join(pair.rod_a, pair.rod_b);
    }
  }
}

/// Rods that are islands of their own are solved for side by side, as many as a pack has lanes;
/// others with their island. A group that has the same rods as before stays as it is, and so do all
/// of them, with their memory, while islands are the same.
void StageSolver::make_groups(const Rods& rods) {
  islands_.find_roots(island_of_);
  if (!groups_.empty() && grouped_ == island_of_) {
    return;
  }
  grouped_ = island_of_;
  std::vector<std::vector<std::uint32_t>> members(rods.count());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    members[island_of_[rod]].push_back(rod);
  }
  std::vector<Group> groups;
  std::map<std::uint32_t, std::size_t> open;  // groups of single rods, by node count
  for (std::uint32_t root = 0; root < rods.count(); ++root) {
    if (members[root].size() == 1) {
      const auto [found, is_new] = open.try_emplace(rods.node_count(root), groups.size());
      if (is_new || groups[found->second].islands == lane_count) {
        found->second = groups.size();
        groups.emplace_back();
        groups.back().packs.emplace_back();
      }
      Group& group = groups[found->second];
      scratch_.islands[root] = group.islands++;
      group.packs.front().push_back(root);
    } else if (!members[root].empty()) {
      Group group;
      group.islands = 1;
      std::map<std::uint32_t, std::vector<std::uint32_t>> alike;  // by node count
      for (const std::uint32_t rod : members[root]) {
        scratch_.islands[rod] = 0;
        alike[rods.node_count(rod)].push_back(rod);
      }
      for (const auto& [node_count, all] : alike) {
        add_packs(all, group.packs);
      }
      groups.push_back(std::move(group));
    }
  }
  for (Group& group : groups) {
    const std::uint32_t first = group.packs.front().front();
    Group* const before = groups_.empty() ? nullptr : &groups_[group_of_[first]];
    if (before != nullptr && before->is_solved && before->packs == group.packs &&
        !travel_bound_.is_final) {
      group = std::move(*before);
    }
  }
  groups_ = std::move(groups);
  for (std::uint32_t index = 0; index < groups_.size(); ++index) {
    for (const std::vector<std::uint32_t>& pack : groups_[index].packs) {
      for (const std::uint32_t rod : pack) {
        group_of_[rod] = index;
      }
    }
    groups_[index].joints.clear();
  }
  for (const JointCluster& cluster : joint_clusters_) {
    groups_[group_of_[cluster.rod(joints_->parts())]].joints.push_back(&cluster);
  }
}

/// Gives each group that is to be solved its contacts.
void StageSolver::distribute_contacts() {
  for (Group& group : groups_) {
    if (!group.is_solved) {
      group.contacts.clear();
    }
  }
  const auto distribute = [&](const auto& all, auto ContactSet::*part, auto rod) {
    for (const auto& each : all) {
      Group& group = groups_[group_of_[each.*rod]];
      if (!group.is_solved) {
        (group.contacts.*part).push_back(each);
      }
    }
  };
  for (const ContactSet& found : found_by_) {
    distribute(found.pairs, &ContactSet::pairs, &EdgePair::rod_a);
    distribute(found.obstacle_contacts, &ContactSet::obstacle_contacts, &ObstacleContact::rod);
    distribute(found.obstacle_edges, &ContactSet::obstacle_edges, &ObstacleEdge::rod);
  }
}

void StageSolver::solve_group(Rods& rods, const Effects& effects, double step, Group& group) {
  std::unique_ptr<NewtonSolver> solver;
  if (!solvers_.try_pop(solver)) {
    solver = std::make_unique<NewtonSolver>();
  }
  solver->assign(rods, group.packs, group.islands, scratch_);
  if (!is_at_start_) {
    copy_state(reference_, group, rods, true);
    solver->begin(rods, effects, step);
    copy_state(start_, group, rods, false);
    solver->load(rods);
  } else {
    solver->begin(rods, effects, step);
  }
  const TravelBound* const travel_bound = contacts_ != nullptr ? &travel_bound_ : nullptr;
  // Without contacts in reach, it suffices to check that the rods end within their travel bounds.
  const bool bounds =
      travel_bound != nullptr && (!group.contacts.is_empty() || travel_bound->is_final);
  const Friction* const friction = bounds ? contacts_->friction() : nullptr;
  const std::optional<double> gain = solver->solve(
      rods, {effects, options_, step, bounds ? &group.contacts : nullptr, travel_bound, friction,
             origins_, is_returning_, has_start_rates_, bounds && contacts_->motions() != nullptr,
             group.joints.empty() ? nullptr : &joints_->parts(), &group.joints});
  group.is_solved = gain.has_value();
  group.stored_gain = gain.value_or(0.0);
  group.has_impacts = solver->has_impacts();
  group.joint_forces.clear();
  if (!group.joints.empty()) {
    group.joint_forces = solver->joint_forces();
  }
  group.reports = solver->reports();
  for (IslandReport& report : group.reports) {
    report.residual_force =
        report.residual * rods.masses[rods.first(report.rod) + report.node] / step;
  }
  group.needed_travel = solver->step_bound().needed();
  group.stuck_objects = solver->stuck_objects();
  group.stuck_progress = solver->stuck_progress();
  solvers_.push(std::move(solver));
}

/// Copies positions and angles of a group's rods, and their rates if asked for.
void StageSolver::copy_state(const RodState& state, const Group& group, Rods& rods,
                             bool has_rates) const {
  for (const std::vector<std::uint32_t>& pack : group.packs) {
    for (const std::uint32_t rod : pack) {
      const auto copy = [&](const auto& from, auto& to) {
        if (!to.empty()) {
          std::copy(from.begin() + rods.first(rod), from.begin() + rods.end(rod),
                    to.begin() + rods.first(rod));
        }
      };
      copy(state.positions, rods.positions);
      copy(state.angles, rods.angles);
      if (has_rates) {
        copy(state.velocities, rods.velocities);
        copy(state.spins, rods.spins);
      }
    }
  }
}

void StageSolver::end_step(const Rods& rods) {
  anchors_.clear();
  for (const Group& group : groups_) {
    group.contacts.add_anchors(rods, anchors_);
    for (const std::vector<std::uint32_t>& pack : group.packs) {
      for (const std::uint32_t rod : pack) {
        is_returning_[rod] = group.has_impacts[scratch_.islands[rod]];
      }
    }
  }
  anchors_.sort(rods.positions.size());
}

bool StageSolver::has_impacts() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const Group& group) {
    return std::find(group.has_impacts.begin(), group.has_impacts.end(), true) !=
           group.has_impacts.end();
  });
}

void StageSolver::add_to(StepReport& report) const {
  std::uint32_t iterations = 0;
  for (const Group& group : groups_) {
    report.energy_gain += group.stored_gain;
    for (const IslandReport& island : group.reports) {
      iterations = std::max(iterations, island.iterations);
      report.impacts += island.impacts;
      report.midpoint_contacts += island.midpoint_contacts;
      report.unbalanced += island.residual > options_.residual ? 1 : 0;
      if (!(island.residual <= report.worst.residual)) {
        report.worst = island;
      }
    }
    if (group.islands == 1 && (group.packs.size() > 1 || group.packs.front().size() > 1)) {
      for (const std::vector<std::uint32_t>& pack : group.packs) {
        report.coupled_rods += static_cast<std::uint32_t>(pack.size());
      }
    }
  }
  report.iterations += iterations;
}

}  // namespace fiber
