#include "fiber_proximity/io/file_error.hpp"

#include <cerrno>
#include <system_error>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

// [byte] The longest path that systems allow: names stay whole.
constexpr std::size_t longest_name = 4096;

}  // namespace

FileError::FileError(const std::string& name, const std::string& reason)
    : std::runtime_error(shortened(name, longest_name) + ": " + reason) {}

FileError::FileError(const std::string& name, std::size_t line, const std::string& reason)
    : std::runtime_error(shortened(name, longest_name) + ":" + std::to_string(line) + ": " +
                         reason) {}

FileError FileError::from_system(const std::string& name, const std::string& what) {
  return {name, what + ": " + std::generic_category().message(errno)};
}

}  // namespace fiber
