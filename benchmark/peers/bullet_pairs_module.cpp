#include <dlfcn.h>

#include <stdexcept>

#include "pairs/makers.hpp"
#include "peers/bullet_pairs.hpp"

namespace fiber {

std::unique_ptr<PairKernel> make_bullet_pairs() {
  // Its own libraries first: those of Bullet in single precision, which the broad phase uses, have
  // the same symbols. The module stays loaded, as its kernels may outlive this call.
  void* const module = dlopen(FIBER_BENCH_BULLET_PAIRS, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  void* const make = module == nullptr ? nullptr : dlsym(module, "fiber_bench_make_bullet_pairs");
  if (make == nullptr) {
    throw std::invalid_argument("the kernel 'bullet' cannot be loaded: " + std::string(dlerror()));
  }
  return std::unique_ptr<PairKernel>(
      reinterpret_cast<decltype(&fiber_bench_make_bullet_pairs)>(make)());
}

}  // namespace fiber
