#pragma once

#include <cstddef>
#include <functional>

namespace fiber {

/// Calls with every index below `count` in a child process, as some libraries abort: after such an
/// end, or a second of computing with one index, another child goes on with the next index. What
/// calls write to SharedArrays stays. No other thread may be running.
/// @throws std::runtime_error if there are no more processes or memory
void guarded_calls(std::size_t count, const std::function<void(std::size_t)>& call);

}  // namespace fiber
