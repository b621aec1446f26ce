#pragma once

#include <cstddef>
#include <functional>

namespace fiber {

/// Calls for 0 … count − 1 on all threads of the caller's arena: one does not fill the way to a
/// GPU, whose compiler does not see TBB.
void on_threads(std::size_t count, const std::function<void(std::size_t)>& call);

}  // namespace fiber
