#include "benchmark/peers/bullet_module.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "benchmark/kernels/makers.hpp"

namespace fiber {
namespace {

/// A function of the module.
template <class Function>
Function* bullet_function(const char* name) {
  // Its own libraries first: those of Bullet in single precision, which the broad phase uses, have
  // the same symbols. The module stays loaded, as its kernels may outlive this call.
  void* const module = dlopen(FIBER_BENCH_BULLET_PAIRS, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  void* const function = module == nullptr ? nullptr : dlsym(module, name);
  if (function == nullptr) {
    throw std::invalid_argument("Bullet's kernels cannot be loaded: " + std::string(dlerror()));
  }
  return reinterpret_cast<Function*>(function);
}

std::unique_ptr<MotionKernel> bullet_motions(BulletCast cast) {
  using Make = decltype(fiber_bench_make_bullet_motions);
  return std::unique_ptr<MotionKernel>(
      bullet_function<Make>("fiber_bench_make_bullet_motions")(cast));
}

}  // namespace

std::unique_ptr<PairKernel> make_bullet_pairs() {
  using Make = decltype(fiber_bench_make_bullet_pairs);
  return std::unique_ptr<PairKernel>(bullet_function<Make>("fiber_bench_make_bullet_pairs")());
}

std::unique_ptr<MotionKernel> make_bullet_continuous_motions() {
  return bullet_motions(BulletCast::CONTINUOUS);
}

std::unique_ptr<MotionKernel> make_bullet_gjk_motions() { return bullet_motions(BulletCast::GJK); }

}  // namespace fiber
