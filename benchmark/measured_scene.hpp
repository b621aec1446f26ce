#pragma once

#include <string>

#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

/// Whether this is a file of fibres, and no scene of the package.
bool is_scene_file(const std::string& name);

/// A scene of the package by its name, or the fibres of a file (read_fibers()): its frames there
/// and back again, so that none jumps; if it has one frame, its points sway.
/// @param motion [mean segment lengths] by which points sway from frame to frame
/// @throws std::invalid_argument for an unknown name, a file without segments or with frames of
///         several topologies, a scale or a seed of a file
/// @throws FileError
Scene measured_scene(const std::string& name, const SceneOptions& options, double motion = 0.02);

/// [mean segment lengths] How far points move from frame 0 to frame 1, in the mean.
double motion_of(const Scene& scene);

}  // namespace fiber
