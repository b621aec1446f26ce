#include "benchmark/kernels/kernel_list.hpp"
#include "benchmark/kernels/makers.hpp"

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

constexpr KernelEntry<MotionKernel> motion_kernels[] = {
    {"own", "", make_own_motions},
    {"own_single", "", make_own_single_motions},
    {"discrete_1", "", make_discrete_1_motions},
    {"discrete_10", "", make_discrete_10_motions},
    {"discrete_100", "", make_discrete_100_motions},
    {"fcl_advancement", "libfcl-dev", make_fcl_advancement_motions},
    {"fcl_naive", "libfcl-dev", make_fcl_naive_motions},
    {"bullet_continuous", "libbullet-dev", make_bullet_continuous_motions},
    {"bullet_gjk", "libbullet-dev", make_bullet_gjk_motions},
};

}  // namespace

std::unique_ptr<PairKernel> make_pair_kernel(const std::string& name) {
  return make_kernel(pair_kernels, name);
}

std::vector<std::string> pair_kernel_names() { return kernel_names(pair_kernels); }

std::unique_ptr<MotionKernel> make_motion_kernel(const std::string& name) {
  return make_kernel(motion_kernels, name);
}

std::vector<std::string> motion_kernel_names() { return kernel_names(motion_kernels); }

}  // namespace fiber
