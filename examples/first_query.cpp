// Two crossing cables, 5 mm thick: where do they touch, and how sure is that?
#include <cstdio>
#include <fiber_proximity/query/engine.hpp>
#include <memory>
#include <vector>

int main() {
  // Points of all fibres one after the other [m], where each fibre begins, and radii [m].
  const std::vector<Eigen::Vector3d> points{{-0.5, 0, 0},
                                            {0, 0, 0},
                                            {0.5, 0, 0},  // the first cable
                                            {0.1, -0.5, 0.012},
                                            {0.1, 0.5, 0.012}};  // the second one
  const fiber::FiberAssembly fibers(points, {0, 3, 5}, {0.005});

  const std::unique_ptr<fiber::ProximityEngine> engine = fiber::make_engine("run_tree");
  engine->update(fibers);

  fiber::QueryOptions options;
  options.margin = 0.01;  // [m] pairs whose surfaces are at most this far apart
  fiber::QueryResult result;
  engine->query(options, result);
  for (const fiber::Contact& contact : result.contacts) {
    std::printf("fibre %u segment %u and fibre %u segment %u: %.4f m apart, from %.17g to %.17g\n",
                contact.fiber_a, contact.segment_a, contact.fiber_b, contact.segment_b,
                contact.distance, contact.lower, contact.upper);
  }
}
