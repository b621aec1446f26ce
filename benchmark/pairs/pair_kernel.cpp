#include "benchmark/pairs/pair_kernel.hpp"

#include "benchmark/pairs/kernel_list.hpp"
#include "benchmark/pairs/makers.hpp"

namespace fiber {
namespace {

constexpr KernelEntry<PairKernel> pair_kernels[] = {
    {"robust", "", make_robust_pairs},
    {"robust_batch", "", make_robust_batch_pairs},
    {"exact", "", make_exact_pairs},
    {"textbook", "", make_textbook_pairs},
    {"fcl_capsule", "libfcl-dev", make_fcl_capsule_pairs},
    {"fcl_gjk", "libfcl-dev", make_fcl_gjk_pairs},
    {"bullet", "libbullet-dev", make_bullet_pairs},
    {"cgal", "libcgal-dev", make_cgal_pairs},
};

}  // namespace

std::unique_ptr<PairKernel> make_pair_kernel(const std::string& name) {
  return make_kernel(pair_kernels, name);
}

std::vector<std::string> pair_kernel_names() { return kernel_names(pair_kernels); }

}  // namespace fiber
