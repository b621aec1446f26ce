#include <stdexcept>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

void check_names(const std::vector<std::string>& names) {
  std::unordered_set<std::string_view> seen;
  seen.reserve(names.size());
  for (std::size_t fiber = 0; fiber < names.size(); ++fiber) {
    const std::string& name = names[fiber];
    const char* const problem = name.empty()                             ? "is empty"
                                : name.size() > FiberNames::longest_name ? "is too long"
                                : name.find('\n') != std::string::npos   ? "has several lines"
                                : !seen.insert(name).second              ? "is that of another, too"
                                                                         : nullptr;
    if (problem != nullptr) {
      throw std::invalid_argument("fibre " + std::to_string(fiber) + ": the name " + quote(name) +
                                  ' ' + problem + "; names are of one line of 1 to " +
                                  std::to_string(FiberNames::longest_name) +
                                  " bytes, and each is another one");
    }
  }
}

}  // namespace

FiberNames::FiberNames(std::vector<std::string> names) {
  std::size_t index = 0;
  while (index < names.size() && names[index] == std::to_string(index)) {
    ++index;
  }
  if (index < names.size()) {
    check_names(names);
    names_ = std::make_shared<const std::vector<std::string>>(std::move(names));
  }
}

std::vector<std::string> FiberNames::list(std::size_t fiber_count) const {
  std::vector<std::string> names;
  names.reserve(fiber_count);
  for (std::size_t fiber = 0; fiber < fiber_count; ++fiber) {
    names.push_back(of(fiber));
  }
  return names;
}

FiberNames FiberNames::select(const std::vector<std::uint32_t>& fibers) const {
  std::vector<std::string> names;
  names.reserve(fibers.size());
  for (const std::uint32_t fiber : fibers) {
    names.push_back(of(fiber));
  }
  return FiberNames(std::move(names));
}

}  // namespace fiber
