// What ranks take for the contacts of a scene that moves: time, and memory.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "src/mpi/communicator.hpp"
#include "src/tools/mpi_tool.hpp"

namespace fiber {
namespace {

struct BenchRequest {
  std::string scene = "soup";
  std::uint64_t segments = 1'000'000;
  std::uint32_t frames = 5;
  QueryOptions query;
  bool without_ranks = false;
  bool is_adopted = false;
  std::uint32_t joined = 0;
};

/// Time and processor time so far [s].
struct Times {
  double wall = 0.0;
  double processor = 0.0;

  static Times now() {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return {
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
        static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec)};
  }
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// [bytes] A field of what Linux says of this process, "VmRSS:" for what it has, "VmHWM:" for the
/// most that it had.
double memory(const std::string& field) {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kibibytes = 0.0;
  while (status >> word) {
    if (word == field) {
      status >> kibibytes;
    }
  }
  return 1024.0 * kibibytes;
}

/// The most is what there is, from now on.
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// [bytes] Of what the engine is given.
double size_of(const DistributedFibers& fibers) {
  const FiberAssembly& parts = fibers.parts;
  return static_cast<double>(sizeof(Eigen::Vector3d) * parts.points().size() +
                             sizeof(std::uint32_t) * parts.offsets().size() +
                             sizeof(double) * parts.radii().size() +
                             sizeof(FiberPart) * fibers.names.size());
}

/// Updates and asks once per frame; the first one, which splits, is not counted.
class Measurement {
 public:
  template <class Frame>
  void run(const Communicator& ranks, std::uint32_t frames, const Frame& frame) {
    for (std::uint32_t i = 0; i <= frames; ++i) {
      frame(i, [&](const auto& work) {
        forget_peak();
        ranks.all(true);  // together
        const Times begin = Times::now();
        work();
        const Times end = Times::now();
        peak_ = std::max(peak_, memory("VmHWM:"));
        if (i > 0) {
          wall_.push_back(ranks.max(end.wall - begin.wall));
          processor_.push_back(end.processor - begin.processor);
        }
      });
    }
  }

  double wall() const { return median(wall_); }
  double processor() const { return median(processor_); }
  double peak() const { return peak_; }  ///< [bytes] that the process had while it worked

 private:
  std::vector<double> wall_;
  std::vector<double> processor_;
  double peak_ = 0.0;
};

/// Fibres of whom each rank makes its own, which are not those it will own.
void make_part(const Communicator& ranks, const LargeScene& scene, std::uint32_t frame,
               DistributedFibers& fibers) {
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  const auto size = static_cast<std::uint64_t>(ranks.size());
  const std::uint64_t begin = scene.fiber_count * rank / size;
  const std::uint64_t end = scene.fiber_count * (rank + 1) / size;
  fibers.parts = FiberAssembly();  // those of before are gone then
  fibers.parts = scene.fibers(begin, end, frame);
  fibers.names.clear();
  fibers.topology = {};
  for (std::uint64_t fiber = begin; fiber < end; ++fiber) {
    fibers.names.push_back({fiber, 0});
  }
}

/// Joins so many fibres that follow each other, wherever they are: the end of one with the start of
/// the next. 1 joins the ends of each fibre; 0 joins nothing.
void join_fibers(std::uint32_t joined, DistributedFibers& fibers) {
  if (joined == 0) {
    return;
  }
  const std::vector<std::uint32_t>& offsets = fibers.parts.offsets();
  fibers.topology.joint_tolerance = std::numeric_limits<double>::infinity();
  fibers.topology.joints.assign(fibers.parts.point_count(), -1);
  for (std::size_t part = 0; part < fibers.names.size(); ++part) {
    const std::uint64_t fiber = fibers.names[part].fiber;
    std::int32_t& start = fibers.topology.joints[offsets[part]];
    std::int32_t& end = fibers.topology.joints[offsets[part + 1] - 1];
    if (joined == 1 || fiber % joined != 0) {
      start = static_cast<std::int32_t>(fiber);
    }
    if (joined == 1) {
      end = start;
    } else if ((fiber + 1) % joined != 0) {
      end = static_cast<std::int32_t>(fiber + 1);
    }
  }
}

/// Moves what a rank has adopted to where it is at a frame.
void move_part(const LargeScene& scene, std::uint32_t frame, DistributedFibers& fibers) {
  constexpr std::uint64_t at_a_time = 1000;  // hair is not made one by one
  const std::vector<std::uint32_t>& offsets = fibers.parts.offsets();
  std::vector<Eigen::Vector3d> points;
  points.reserve(fibers.parts.points().size());
  FiberAssembly whole;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  for (std::size_t part = 0; part < fibers.names.size(); ++part) {
    const FiberPart& name = fibers.names[part];
    if (name.fiber >= end) {
      begin = name.fiber;
      end = std::min(begin + at_a_time, scene.fiber_count);
      whole = scene.fibers(begin, end, frame);
    }
    const auto first = whole.points().begin() + whole.offsets()[name.fiber - begin] +
                       static_cast<std::ptrdiff_t>(name.first_segment);
    points.insert(points.end(), first, first + (offsets[part + 1] - offsets[part]));
  }
  fibers.parts.exchange_points(points);
}

ExitCode run(const BenchRequest& request) {
  const Communicator ranks(MPI_COMM_WORLD);
  const LargeScene scene = make_large_scene(request.scene, request.segments);
  const double baseline = memory("VmRSS:");
  EngineOptions one_thread;
  one_thread.threads = 1;
  Measurement measurement;
  DistributedFacts facts;
  double halo = 0.0;  // for each own segment of all ranks, after the first split
  std::uint64_t pairs = 0;
  DistributedFibers fibers;
  if (request.without_ranks) {
    const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", one_thread);
    QueryResult result;
    std::vector<Eigen::Vector3d> points;
    measurement.run(ranks, request.frames, [&](std::uint32_t frame, const auto& measure) {
      make_part(ranks, scene, frame, fibers);
      measure([&] {
        engine->update(fibers.parts);
        engine->query(request.query, result);
      });
      pairs = result.contacts.size();
    });
    facts.own_segments = fibers.parts.segment_count();
  } else {
    DistributedEngine engine(MPI_COMM_WORLD, one_thread);
    DistributedResult result;
    std::uint64_t splits = 0;
    measurement.run(ranks, request.frames, [&](std::uint32_t frame, const auto& measure) {
      if (request.is_adopted && frame > 0) {
        move_part(scene, frame, fibers);
      } else {
        make_part(ranks, scene, frame, fibers);
        join_fibers(request.joined, fibers);
      }
      measure([&] {
        engine.update(fibers.parts, fibers.names, fibers.topology);
        engine.query(request.query, result);
      });
      facts = engine.facts();
      if (frame == 0) {
        halo = static_cast<double>(ranks.sum(facts.halo_segments)) /
               static_cast<double>(ranks.sum(facts.own_segments));
      }
      if (request.is_adopted && facts.split_count > splits) {
        splits = facts.split_count;
        fibers = engine.adopt();
      }
      pairs = ranks.sum(result.contacts.size());
    });
  }
  const double processor = ranks.max(measurement.processor());
  const double memory = ranks.max((measurement.peak() - baseline - size_of(fibers)) /
                                  static_cast<double>(facts.own_segments + facts.halo_segments));
  const double joined = static_cast<double>(ranks.sum(facts.joined_segments)) /
                        static_cast<double>(ranks.sum(facts.own_segments));
  if (ranks.rank() == 0) {
    nlohmann::ordered_json line;
    line["scene"] = request.scene;
    line["segments"] = scene.segment_count();
    line["ranks"] = ranks.size();
    line["engine"] = request.without_ranks ? "run_tree" : "DistributedEngine";
    line["cycle_ms"] = 1e3 * measurement.wall();
    line["processor_ms"] = 1e3 * processor;
    line["pairs"] = pairs;
    line["halo"] = halo;
    line["joined"] = joined;
    line["bytes_per_segment"] = memory;
    line["splits"] = facts.split_count;
    std::cout << line.dump() << "\n";
  }
  return SUCCEEDED;
}

void setup(CLI::App& app, Command& command) {
  const auto request = std::make_shared<BenchRequest>();
  request->query.margin = 1e-4;
  command = [request] { return run(*request); };
  app.add_option("--scene", request->scene, "one of " + join(large_scene_names()))
      ->capture_default_str();
  app.add_option("--segments", request->segments, "at least, in whole fibres")
      ->capture_default_str();
  app.add_option("--frames", request->frames, "to measure, after the first one")
      ->check(whole_number(1))
      ->capture_default_str();
  app.add_option("--margin", request->query.margin, "[m]")->capture_default_str();
  app.add_option("--joined", request->joined,
                 "join so many fibres that follow each other, end to start, wherever they are; 1: "
                 "the ends of each fibre")
      ->check(whole_number(0))
      ->capture_default_str();
  app.add_flag("--adopt", request->is_adopted, "ranks bring what they hold, after each split");
  app.add_flag("--without-ranks", request->without_ranks,
               "ask an engine run_tree of one thread, as a program without MPI does");
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_mpi_tool("fiber_bench_mpi",
                             "Time and memory of contacts over ranks, as JSON Lines", fiber::setup,
                             argc, argv);
}
