#pragma once

#include "benchmark/kernels/motion_kernel.hpp"
#include "benchmark/kernels/pair_kernel.hpp"

namespace fiber {

/// Bullet's convex casts.
enum class BulletCast { CONTINUOUS, GJK };

}  // namespace fiber

// The module with Bullet in double precision offers these functions, which make kernels.
extern "C" {
__attribute__((visibility("default"))) fiber::PairKernel* fiber_bench_make_bullet_pairs();
__attribute__((visibility("default"))) fiber::MotionKernel* fiber_bench_make_bullet_motions(
    fiber::BulletCast cast);
}
