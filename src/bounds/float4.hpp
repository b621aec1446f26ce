#pragma once

namespace fiber {

/// Four floats that every 64-bit machine computes at once: a feature of GCC and Clang that needs no
/// instruction set beyond the target's own. Read and set its values by index.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 min(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max(Float4 a, Float4 b) { return a < b ? b : a; }

}  // namespace fiber
