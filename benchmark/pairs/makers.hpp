#pragma once

#include <memory>

#include "benchmark/pairs/pair_kernel.hpp"

namespace fiber {

/// Makes a kernel; null where this build is without it.
using PairKernelMaker = std::unique_ptr<PairKernel> (*)();

std::unique_ptr<PairKernel> make_robust_pairs();
std::unique_ptr<PairKernel> make_robust_batch_pairs();
std::unique_ptr<PairKernel> make_exact_pairs();
std::unique_ptr<PairKernel> make_textbook_pairs();

#ifdef FIBER_BENCH_HAS_FCL
std::unique_ptr<PairKernel> make_fcl_capsule_pairs();
std::unique_ptr<PairKernel> make_fcl_gjk_pairs();
#else
constexpr PairKernelMaker make_fcl_capsule_pairs = nullptr;
constexpr PairKernelMaker make_fcl_gjk_pairs = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_BULLET_PAIRS
std::unique_ptr<PairKernel> make_bullet_pairs();
#else
constexpr PairKernelMaker make_bullet_pairs = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_CGAL_PAIRS
std::unique_ptr<PairKernel> make_cgal_pairs();
#else
constexpr PairKernelMaker make_cgal_pairs = nullptr;
#endif

}  // namespace fiber
