#pragma once

#include "pairs/pair_kernel.hpp"

/// What the module with Bullet in double precision offers: a new kernel.
extern "C" __attribute__((visibility("default"))) fiber::PairKernel*
fiber_bench_make_bullet_pairs();
