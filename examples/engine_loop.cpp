// A cable that swings beside another, frame by frame: the engine keeps its hierarchy and refits it,
// and a motion query finds what happens between two frames.
#include <cmath>
#include <cstdio>
#include <fiber_proximity/query/engine.hpp>
#include <memory>
#include <vector>

namespace {

/// A cable that stands still, and one whose lower end swings through it.
std::vector<Eigen::Vector3d> points_at(double time) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 20; ++i) {
    points.emplace_back(0.0, 0.05 * i - 0.5, 0.0);
  }
  for (int i = 0; i <= 20; ++i) {
    const double down = 0.05 * i;
    points.emplace_back(down * std::sin(0.8 * std::cos(6.0 * time)), 0.0, 0.5 - down);
  }
  return points;
}

}  // namespace

int main() {
  constexpr double period = 1.0 / 30.0;  // [s] of the frames
  fiber::FiberAssembly before(points_at(0.0), {0, 21, 42}, {0.004});
  fiber::FiberAssembly now = before;
  const std::unique_ptr<fiber::ProximityEngine> engine = fiber::make_engine("run_tree");
  const std::unique_ptr<fiber::ProximityEngine> between = fiber::make_engine("run_tree");
  fiber::QueryOptions options;
  fiber::QueryResult contacts;
  fiber::MotionOptions motion_options;
  motion_options.type = fiber::MotionType::FIRST;
  fiber::MotionResult motion;

  for (int frame = 1; frame <= 30; ++frame) {
    now.update_points(points_at(period * frame));  // nothing is allocated
    engine->update(now);
    engine->query(options, contacts);
    between->update_motion(before, now);
    between->query_motion(motion_options, motion);
    if (const fiber::MotionContact* const first = motion.earliest()) {
      std::printf("frame %d: %zu contacts now, the first after %.3f ms of the step\n", frame,
                  contacts.contacts.size(), 1e3 * period * first->lower);
    }
    before.update_points(now.points());
  }
}
