#include <array>

#include "benchmark/environment/camera_cloud.hpp"
#include "benchmark/environment/measurements.hpp"
#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

struct OctreeRun {
  double resolution;  // [m]
  std::vector<double> times_ms;
  std::size_t cells = 0;
};

}  // namespace

void measure_octree(const EnvironmentMeasurement& what, const ReportRow& report) {
  const std::vector<Eigen::Vector3d> cloud = camera_cloud(what.pixels, what.seed);
  std::array<OctreeRun, 2> runs{{{0.01, {}}, {0.02, {}}}};
  Progress progress;
  for (std::uint32_t repeat = 1; repeat <= what.repeats; ++repeat) {
    progress.show("cloud " + std::to_string(repeat) + " of " + std::to_string(what.repeats));
    for (std::size_t turn = 0; turn < runs.size(); ++turn) {
      OctreeRun& run = runs[(repeat + turn) % runs.size()];
      run.times_ms.push_back(time_of([&] {
        std::vector<OccupancyOctree::Cell> cells;
        cells.reserve(cloud.size());
        for (const Eigen::Vector3d& point : cloud) {
          cells.push_back(OccupancyOctree::cell_at(run.resolution, point).value());
        }
        run.cells = OccupancyOctree(run.resolution, std::move(cells)).centres().size();
      }));
    }
  }
  for (const OctreeRun& run : runs) {
    report({{"resolution", run.resolution},
            {"build_ms", median(run.times_ms)},
            {"cells", run.cells},
            {"pixels", what.pixels},
            {"seed", what.seed},
            {"repeats", what.repeats}});
  }
}

}  // namespace fiber
