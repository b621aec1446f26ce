#pragma once

#include <stdexcept>
#include <string>

namespace fiber::test {

/// What std::invalid_argument the function throws says, or that there is none.
template <class Function>
std::string error_of(const Function& function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace fiber::test
