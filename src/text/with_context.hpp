#pragma once

#include <stdexcept>
#include <string>

namespace fiber {

/// Calls a function; what it refuses (std::invalid_argument) begins with what it was about.
template <class Function>
auto with_context(const std::string& context, const Function& function) {
  try {
    return function();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(context + ": " + error.what());
  }
}

}  // namespace fiber
