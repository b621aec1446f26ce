#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fiber {

/// How the distance of two segments is computed; docs/numerics.md has the bounds of each.
enum class Kernel {
  ROBUST,  ///< in double precision
  EXACT    ///< in integers as long as it takes, rounded once at the end
};

/// The kernel of this name: robust or exact.
/// @throws std::invalid_argument listing the names
Kernel kernel_from_name(const std::string& name);

/// What a kernel of the version before this is called now: `fast`, which saved no time, is robust;
/// every other name is as it is.
std::string current_kernel_name(const std::string& name);

/// All names, in the order of Kernel.
const std::vector<std::string>& kernel_names();

inline const std::string& name_of(Kernel kernel) {
  return kernel_names()[static_cast<std::size_t>(kernel)];
}

}  // namespace fiber
