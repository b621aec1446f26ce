#pragma once

#include <cstddef>

namespace fiber {

/// memcpy() on all threads of the caller's arena: one does not fill the way to a GPU.
void copy_on_threads(void* to, const void* from, std::size_t bytes);

}  // namespace fiber
