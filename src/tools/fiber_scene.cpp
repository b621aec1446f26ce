#include <memory>
#include <optional>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {
namespace {

struct Request {
  std::string name;
  SceneOptions options;
  std::optional<std::uint32_t> frames;
  std::string out;
};

ExitCode run(const Request& request) {
  const Scene scene = make_scene(request.name, request.options);
  const FiberAssembly first = scene(0);  // a scene that cannot be made leaves no file behind
  FiberWriter writer(request.out, request.frames.has_value());
  writer.write({0, first});
  for (std::uint32_t frame = 1; frame < request.frames.value_or(1); ++frame) {
    writer.write({frame, scene(frame)});
  }
  writer.finish();
  return SUCCEEDED;
}

void setup(CLI::App& app, Command& command) {
  const auto request = std::make_shared<Request>();
  command = [request] { return run(*request); };
  app.add_option("NAME", request->name, "one of " + join(scene_names()))->required();
  app.add_option("--scale", request->options.scale, "of the number of fibres")
      ->capture_default_str();
  app.add_option("--frames", request->frames,
                 "frames to write, numbered from 0; without: the first, without a number")
      ->check(whole_number(1));
  app.add_option("--seed", request->options.seed, "of all that is random")
      ->check(whole_number(0))
      ->capture_default_str();
  app.add_flag("--shuffle", request->options.shuffle, "put the fibres into random order");
  app.add_option("--out", request->out,
                 "file to write; .hair holds one frame, without a number; .pvd is for ParaView")
      ->required();
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_tool("fiber_scene",
                         "Writes a scene as a fibre file (.csv or .hair), or for ParaView (.pvd)",
                         fiber::setup, argc, argv);
}
