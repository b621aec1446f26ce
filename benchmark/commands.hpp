#pragma once

#include "src/tools/command_line.hpp"

namespace fiber {

/// `update` and `cycle`: engines on a moving scene.
void add_scene_commands(CLI::App& app, Command& command);

/// `stages`: one engine on one scene, for the figures of the paper.
void add_stages_command(CLI::App& app, Command& command);

/// `coherence`: what a skin is worth on a scene that moves a little in every frame.
void add_coherence_command(CLI::App& app, Command& command);

/// `accuracy`: kernels, tolerances and deadlines on a moving scene.
void add_accuracy_command(CLI::App& app, Command& command);

/// `kernels`: distances of two segments, their errors and times on hard pairs.
void add_kernels_command(CLI::App& app, Command& command);

/// `motions`: when moving capsules touch, judged against the truth and beside other libraries.
void add_motions_command(CLI::App& app, Command& command);

/// `environment`: a cell with a robot beside FCL, octrees of clouds, batches of candidates.
void add_environment_command(CLI::App& app, Command& command);

/// `simulate`: the simulation of rods, its accuracy, its time and what each effect costs.
void add_simulate_command(CLI::App& app, Command& command);

/// `device`: contacts that stay on a GPU.
void add_device_command(CLI::App& app, Command& command);

/// `latency`: a running ROS graph; only in builds with ROS.
void add_latency_command(CLI::App& app, Command& command);

/// `obstacle_latency`: the same, for obstacles beside bad and large ones.
void add_obstacle_latency_command(CLI::App& app, Command& command);

}  // namespace fiber
