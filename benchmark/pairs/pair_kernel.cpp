#include "pairs/pair_kernel.hpp"

#include <stdexcept>

#include "pairs/makers.hpp"

namespace fiber {
namespace {

struct Entry {
  const char* name;
  const char* packages;  // of Debian
  PairKernelMaker make;  // null: not in this build
};

constexpr Entry entries[] = {
    {"fast", "", make_fast_pairs},
    {"fast_batch", "", make_fast_batch_pairs},
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
  std::string known;
  for (const Entry& entry : entries) {
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
    if (name != entry.name) {
      continue;
    }
    if (entry.make == nullptr) {
      throw std::invalid_argument("this build is without the kernel '" + name + "': install " +
                                  entry.packages + " (scripts/setup.sh --bench), then build again");
    }
    return entry.make();
  }
  throw std::invalid_argument("unknown kernel '" + name + "', known are: " + known);
}

std::vector<std::string> pair_kernel_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries) {
    if (entry.make != nullptr) {
      names.emplace_back(entry.name);
    }
  }
  return names;
}

}  // namespace fiber
