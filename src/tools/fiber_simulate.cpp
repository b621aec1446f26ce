#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/io/file_format.hpp"
#include "src/sim/scene/force_file.hpp"
#include "src/sim/scene/prediction_observer.hpp"
#include "src/sim/scene/report.hpp"
#include "src/text/quote.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

using Clock = std::chrono::steady_clock;

struct Request {
  std::string scene;
  double seconds = 0.0;
  std::string out;
  std::string forces;                          // empty for none
  std::string trajectory;                      // empty for none
  double margin = PredictionOptions{}.margin;  // [m] of what is told of a trajectory
  std::uint32_t threads = 0;
};

/// A bar on a terminal, renewed some times a second.
class Bar {
 public:
  explicit Bar(Progress& progress) : progress_(progress) {}

  void show(std::int64_t frame, std::int64_t frames, double time) {
    constexpr std::chrono::milliseconds period(100);
    constexpr std::size_t width = 30;
    const Clock::time_point now = Clock::now();
    if (now - shown_ < period) {
      return;
    }
    shown_ = now;
    const double share = static_cast<double>(frame) / static_cast<double>(frames);
    const double taken = std::chrono::duration<double>(now - begin_).count();
    std::string bar(static_cast<std::size_t>(share * static_cast<double>(width)), '#');
    bar.resize(width, ' ');
    std::ostringstream text;
    text.precision(3);
    text << '[' << bar << "] " << time << " s of the scene, " << time / taken
         << " times as fast as the clock, " << std::round(taken / share - taken) << " s left";
    progress_.show(text.str());
  }

 private:
  Progress& progress_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point shown_;
};

void require_different(const std::string& option, const std::string& file, const std::string& what,
                       const std::string& other) {
  namespace fs = std::filesystem;
  std::error_code none;
  const auto place = [](const std::string& name) { return fs::absolute(name).lexically_normal(); };
  if (place(file) == place(other) || fs::equivalent(file, other, none)) {
    throw std::invalid_argument(option + " is " + what + " itself, " + quote(file));
  }
}

/// Tells what goes wrong when it does so first, and how often it has in the end.
class Warnings {
 public:
  explicit Warnings(Progress& progress) : progress_(progress) {}

  void tell(const SimScene& scene) {
    for (const SimWarning& warning : frame_warnings(scene)) {
      const auto kind = static_cast<std::size_t>(warning.kind);
      if (frames_[kind]++ == 0) {
        std::ostringstream text;
        text << "after " << scene.stepper->time() << " s: " << warning.text;
        firsts_[kind] = text.str();
        progress_.show("");
        std::cerr << "warning: " << text.str() << '\n';
      }
    }
  }

  void sum_up(std::int64_t frames) const {
    for (std::size_t kind = 0; kind < frames_.size(); ++kind) {
      if (frames_[kind] > 1) {
        std::cerr << "warning: so in " << frames_[kind] << " of " << frames << " frames, first "
                  << firsts_[kind] << '\n';
      }
    }
  }

 private:
  Progress& progress_;
  std::array<std::int64_t, SimWarning::kinds> frames_{};
  std::array<std::string, SimWarning::kinds> firsts_;
};

/// How far from balance frames end of a scene that asks for few iterations: it knows that they may.
class Balance {
 public:
  void look_at(const SimScene& scene) {
    const StepReport& report = scene.frame;
    const IslandReport& worst = report.worst;
    unbalanced_ += report.unbalanced > 0 ? 1 : 0;
    max_gain_ = std::max(max_gain_, report.energy_gain);
    if (worst.residual > residual_) {
      residual_ = worst.residual;
      std::ostringstream text;
      text << worst.residual << " m/s a step (" << worst.residual_force << " N at node "
           << worst.node << " of fibre " << quote(scene.fiber_names[worst.rod]) << ", after "
           << scene.stepper->time() << " s)";
      where_ = text.str();
    }
  }

  void sum_up(const SimScene& scene, std::int64_t frames) const {
    if (unbalanced_ > 0 && scene.asks_for_few_iterations()) {
      std::cerr << "note: " << unbalanced_ << " of " << frames << " frames end after "
                << scene.options.max_iterations
                << " iterations, as the scene asks, before forces balance: what is left would "
                   "change a speed by up to "
                << where_ << "; the most energy that a step gained is " << max_gain_ << " J\n";
    }
  }

 private:
  std::int64_t unbalanced_ = 0;
  double max_gain_ = 0.0;  // [J]
  double residual_ = 0.0;  // [m/s]
  std::string where_;
};

SimScene make_scene(const Request& request) {
  require_different("--out", request.out, "the scene", request.scene);
  if (!request.forces.empty()) {
    require_different("--forces", request.forces, "the scene", request.scene);
    require_different("--forces", request.forces, "--out", request.out);
    require_format(FileFormat::CSV, "--forces", request.forces);
  }
  const MeshSource meshes = mesh_files(std::filesystem::path(request.scene).parent_path());
  SimDescription description = read_sim_scene(load_yaml(request.scene), meshes);
  if (!request.trajectory.empty()) {
    replace_holds(load_yaml(request.trajectory), description);
  }
  SimScene scene = make_sim_scene(description, request.threads);
  if (!scene.obstacle_frames.empty()) {
    const FollowedObstacle& followed = scene.obstacle_frames.front();
    throw std::invalid_argument(followed.what + " follows frame " + quote(followed.frame) +
                                " of tf: that is for cable_sim, here it must have a path");
  }
  if (!scene.frames.empty()) {
    const FollowedFrame& frame = scene.frames.front();
    throw std::invalid_argument(frame.what + " follows frame " + quote(frame.frame) +
                                " of tf: that is for cable_sim, here it must be held by a path");
  }
  return scene;
}

/// The number of frames that last so long. Time steps are mostly written with few digits, so hardly
/// more than a whole number of them counts as whole.
std::int64_t frames_in(double seconds, double time_step) {
  constexpr double max = 1e9;
  const double frames = std::ceil(seconds / time_step * (1.0 - 1e-9));
  if (!(frames <= max)) {
    std::ostringstream error;
    error << "--seconds is " << seconds << ": that is more than " << max << " frames of "
          << time_step << " s";
    throw std::invalid_argument(error.str());
  }
  return static_cast<std::int64_t>(frames);
}

void advance(SimScene& scene) {
  const double begin = scene.stepper->time();
  try {
    scene.advance();
  } catch (const std::runtime_error& error) {
    std::ostringstream text;
    text << "after " << begin << " s of the scene: " << error.what();
    throw std::runtime_error(text.str());
  }
}

ExitCode run(const Request& request) {
  SimScene scene = make_scene(request);  // what cannot be made leaves no file behind
  const std::int64_t frames = frames_in(request.seconds, scene.time_step);
  if (!scene.real_time_note.empty()) {
    std::cerr << "note: " << scene.real_time_note << '\n';
  }
  for (const std::string& omission : omissions(scene)) {
    std::cerr << "warning: " << omission << '\n';
  }
  const Rods& rods = scene.stepper->rods();
  FiberFrame frame{0, assembly_of(rods)};
  FiberWriter writer(request.out, true);
  writer.write(frame, 0.0);
  std::optional<ForceWriter> forces;
  if (!request.forces.empty()) {
    forces.emplace(request.forces);
  }
  Progress progress;
  Bar bar(progress);
  Warnings warnings(progress);
  Balance balance;
  std::optional<PredictionObserver> observer;
  if (!request.trajectory.empty()) {
    PredictionOptions options;
    options.margin = request.margin;
    observer.emplace(scene, options);
    observer->look();
  }
  while (frame.frame < frames) {
    advance(scene);
    ++frame.frame;
    frame.fibers.update_points(rods.positions);
    writer.write(frame, scene.stepper->time());
    if (forces) {
      forces->write(frame.frame, rods, scene.stepper->forces());
    }
    if (observer) {
      observer->keep_warnings();
      observer->look();
    }
    warnings.tell(scene);
    balance.look_at(scene);
    bar.show(frame.frame, frames, scene.stepper->time());
  }
  writer.finish();
  if (forces) {
    forces->finish();
  }
  progress.show("");
  warnings.sum_up(frames);
  balance.sum_up(scene, frames);
  if (observer) {
    std::cout << summary(observer->take(), scene, request.margin);
  }
  return SUCCEEDED;
}

void setup(CLI::App& app, Command& command) {
  const auto request = std::make_shared<Request>();
  command = [request] { return run(*request); };
  app.add_option("SCENE", request->scene, "YAML file of a scene (docs/simulation.md)")->required();
  app.add_option("--seconds", request->seconds, "how far to simulate [s]")
      ->check(finite_number(0.0))
      ->required();
  app.add_option(
         "--out", request->out,
         "file to write: CSV, or .pvd for ParaView, with a .vtp file for each frame beside it")
      ->required();
  app.add_option("--forces", request->forces,
                 "CSV file to write: what acts in the fibres and on them, frame by frame");
  CLI::Option* const trajectory = app.add_option(
      "--trajectory", request->trajectory,
      "YAML file: a list of holds with their paths, as the effect attachment has them "
      "(docs/scene_keys.md), in place of the scene's at the same nodes; what comes of it is told "
      "on "
      "stdout: least distances, contacts and greatest forces, and when");
  app.add_option("--margin", request->margin,
                 "with --trajectory: least distances up to this are told [m]")
      ->check(finite_number(0.0))
      ->capture_default_str()
      ->needs(trajectory);
  app.add_option("--threads", request->threads,
                 "most threads to use, 0: as many as there are cores; the frames are the same")
      ->capture_default_str();
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_tool(
      "fiber_simulate", "Simulates the fibres of a scene and writes where they are, frame by frame",
      fiber::setup, argc, argv);
}
