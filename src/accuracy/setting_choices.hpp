#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/accuracy/answer_setting.hpp"

namespace fiber {

/// Chooses what depends on the frames: skins by how far points move, errors of chords that leave
/// out enough points, another number of threads than the engine's, and of the other engines those
/// that do not take too long.
/// @param step     [m] that points move from frame to frame, 0 where it is not known
/// @param choices  with the engine, its options and other engines
/// @param left_out told what is not compared, and why
void choose_by_frames(const std::vector<FiberFrame>& frames, double step, SettingChoices& choices,
                      std::vector<std::string>& left_out);

}  // namespace fiber
