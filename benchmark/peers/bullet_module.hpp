#pragma once

#include "benchmark/continuous/motion_kernel.hpp"
#include "benchmark/pairs/pair_kernel.hpp"

namespace fiber {

/// Bullet's convex casts.
enum class BulletCast { CONTINUOUS, GJK };

}  // namespace fiber

// What the module with Bullet in double precision offers: new kernels.
extern "C" {
__attribute__((visibility("default"))) fiber::PairKernel* fiber_bench_make_bullet_pairs();
__attribute__((visibility("default"))) fiber::MotionKernel* fiber_bench_make_bullet_motions(
    fiber::BulletCast cast);
}
