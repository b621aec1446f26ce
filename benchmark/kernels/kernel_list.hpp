#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace fiber {

/// A kernel that there is, in this build or not.
template <class Kernel>
struct KernelEntry {
  const char* name;
  const char* packages;               ///< of Debian; empty for ours
  std::unique_ptr<Kernel> (*make)();  ///< null: not in this build
};

/// The kernel of this name.
/// @throws std::invalid_argument for an unknown name, listing the names, and for a kernel this
///         build is without, naming the package to install
template <class Kernel, std::size_t count>
std::unique_ptr<Kernel> make_kernel(const KernelEntry<Kernel> (&entries)[count],
                                    const std::string& name) {
  std::string known;
  for (const KernelEntry<Kernel>& entry : entries) {
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

/// Names of the kernels in this build.
template <class Kernel, std::size_t count>
std::vector<std::string> kernel_names(const KernelEntry<Kernel> (&entries)[count]) {
  std::vector<std::string> names;
  for (const KernelEntry<Kernel>& entry : entries) {
    if (entry.make != nullptr) {
      names.emplace_back(entry.name);
    }
  }
  return names;
}

}  // namespace fiber
