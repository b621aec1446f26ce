#pragma once

#include <memory>

#include "benchmark/kernels/motion_kernel.hpp"
#include "benchmark/kernels/pair_kernel.hpp"

namespace fiber {

/// Makes a kernel; null where this build is without it.
using PairKernelMaker = std::unique_ptr<PairKernel> (*)();
using MotionKernelMaker = std::unique_ptr<MotionKernel> (*)();

std::unique_ptr<PairKernel> make_robust_pairs();
std::unique_ptr<PairKernel> make_robust_batch_pairs();
std::unique_ptr<PairKernel> make_exact_pairs();
std::unique_ptr<PairKernel> make_textbook_pairs();
std::unique_ptr<MotionKernel> make_own_motions();
std::unique_ptr<MotionKernel> make_own_single_motions();
std::unique_ptr<MotionKernel> make_discrete_1_motions();
std::unique_ptr<MotionKernel> make_discrete_10_motions();
std::unique_ptr<MotionKernel> make_discrete_100_motions();

#ifdef FIBER_BENCH_HAS_FCL
std::unique_ptr<PairKernel> make_fcl_capsule_pairs();
std::unique_ptr<PairKernel> make_fcl_gjk_pairs();
std::unique_ptr<MotionKernel> make_fcl_advancement_motions();
std::unique_ptr<MotionKernel> make_fcl_naive_motions();
#else
constexpr PairKernelMaker make_fcl_capsule_pairs = nullptr;
constexpr PairKernelMaker make_fcl_gjk_pairs = nullptr;
constexpr MotionKernelMaker make_fcl_advancement_motions = nullptr;
constexpr MotionKernelMaker make_fcl_naive_motions = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_BULLET_PAIRS
std::unique_ptr<PairKernel> make_bullet_pairs();
std::unique_ptr<MotionKernel> make_bullet_continuous_motions();
std::unique_ptr<MotionKernel> make_bullet_gjk_motions();
#else
constexpr PairKernelMaker make_bullet_pairs = nullptr;
constexpr MotionKernelMaker make_bullet_continuous_motions = nullptr;
constexpr MotionKernelMaker make_bullet_gjk_motions = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_CGAL_PAIRS
std::unique_ptr<PairKernel> make_cgal_pairs();
#else
constexpr PairKernelMaker make_cgal_pairs = nullptr;
#endif

}  // namespace fiber
