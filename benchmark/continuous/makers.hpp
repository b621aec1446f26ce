#pragma once

#include <memory>

#include "benchmark/continuous/motion_kernel.hpp"

namespace fiber {

/// Makes a kernel; null where this build is without it.
using MotionKernelMaker = std::unique_ptr<MotionKernel> (*)();

std::unique_ptr<MotionKernel> make_own_motions();
std::unique_ptr<MotionKernel> make_own_single_motions();
std::unique_ptr<MotionKernel> make_discrete_1_motions();
std::unique_ptr<MotionKernel> make_discrete_10_motions();
std::unique_ptr<MotionKernel> make_discrete_100_motions();

#ifdef FIBER_BENCH_HAS_FCL
std::unique_ptr<MotionKernel> make_fcl_advancement_motions();
std::unique_ptr<MotionKernel> make_fcl_naive_motions();
#else
constexpr MotionKernelMaker make_fcl_advancement_motions = nullptr;
constexpr MotionKernelMaker make_fcl_naive_motions = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_BULLET_PAIRS
std::unique_ptr<MotionKernel> make_bullet_continuous_motions();
std::unique_ptr<MotionKernel> make_bullet_gjk_motions();
#else
constexpr MotionKernelMaker make_bullet_continuous_motions = nullptr;
constexpr MotionKernelMaker make_bullet_gjk_motions = nullptr;
#endif

}  // namespace fiber
