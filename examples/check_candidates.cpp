// Where could a cable hang? Candidates at several heights, checked against a cell, a cable that is
// there, and themselves.
#include <cstdio>
#include <fiber_proximity/environment/check_fibers.hpp>
#include <memory>
#include <vector>

namespace {

/// A straight cable along y, 5 mm thick [m].
fiber::FiberAssembly cable(double x, double z) {
  return {{{x, -0.5, z}, {x, 0, z}, {x, 0.5, z}}, {0, 3}, {0.005}};
}

/// A floor and a post of 10 cm across that stands on it.
fiber::Environment cell() {
  fiber::EnvironmentObject floor{"floor", Eigen::Isometry3d::Identity(), {}};
  floor.shapes.push_back({fiber::HalfSpaceShape{}});  // z <= 0
  fiber::EnvironmentObject post{"post", Eigen::Isometry3d::Identity(), {}};
  post.pose.translation().z() = 0.25;
  post.shapes.push_back({fiber::CylinderShape{0.05, 0.5}});
  return fiber::Environment({floor, post});
}

}  // namespace

int main() {
  const fiber::Environment environment = cell();
  const std::unique_ptr<fiber::ProximityEngine> there = fiber::make_engine("run_tree");
  const fiber::FiberAssembly cable_there = cable(0.01, 0.8);
  there->update(cable_there);

  fiber::Surroundings surroundings;
  surroundings.environment = &environment;
  surroundings.fibers = there.get();
  fiber::QueryOptions options;
  options.type = fiber::QueryType::FIRST;  // the fastest: a check ends at its first contact
  options.margin = 0.01;                   // [m]

  std::vector<fiber::FiberAssembly> candidates;
  for (const double z : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    candidates.push_back(cable(0.0, z));
  }
  std::vector<fiber::FiberCheck> checks;
  fiber::check_fibers(candidates, surroundings, options, checks);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const fiber::FiberCheck& check = checks[i];
    const char* const what =
        check.is_free() ? "free"
        : !check.environment.contacts.empty()
            ? environment.objects()[check.environment.contacts.front().fiber_b].name.c_str()
            : "the cable that is there";
    std::printf("%.1f m: %s\n", candidates[i].points().front().z(), what);
  }
}
