#pragma once

#include "command_line.hpp"

namespace fiber {

/// `update` and `cycle`: engines on a moving scene.
void add_scene_commands(CLI::App& app, Command& command);

/// `stages`: one engine on one scene, for the figures of the paper.
void add_stages_command(CLI::App& app, Command& command);

/// `coherence`: what a skin is worth on a scene that moves a little in every frame.
void add_coherence_command(CLI::App& app, Command& command);

/// `latency`: a running ROS graph; only in builds with ROS.
void add_latency_command(CLI::App& app, Command& command);

}  // namespace fiber
