#include "benchmark/commands.hpp"
#include "fiber_proximity/cuda/cuda_engines.hpp"
#include "fiber_proximity/paper/paper_engines.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {
namespace {

void setup(CLI::App& app, Command& command) {
  register_paper_engines();
  register_cuda_engines();
  app.require_subcommand(0, 1);
  add_scene_commands(app, command);
  add_stages_command(app, command);
  add_accuracy_command(app, command);
  add_coherence_command(app, command);
  add_kernels_command(app, command);
  add_motions_command(app, command);
  add_environment_command(app, command);
  add_simulate_command(app, command);
  add_device_command(app, command);
#ifdef FIBER_BENCH_HAS_LATENCY
  add_latency_command(app, command);
  add_obstacle_latency_command(app, command);
#endif
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_tool("fiber_bench", "Measures what updates and queries cost", fiber::setup,
                         argc, argv);
}
