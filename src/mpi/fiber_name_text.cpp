#include "src/mpi/fiber_name_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace fiber {

std::vector<char> text_of_names(const FiberNames& names) {
  std::vector<char> text;
  for (const std::string& name : names.list(names.size())) {
    text.insert(text.end(), name.begin(), name.end());
    text.push_back('\n');
  }
  return text;
}

FiberNames names_in_text(const std::vector<char>& text) {
  std::vector<std::string> names;
  for (auto begin = text.begin(); begin != text.end();) {
    const auto end = std::find(begin, text.end(), '\n');
    if (end == text.end()) {
      throw std::runtime_error("the last name of a fibre has no end");
    }
    names.emplace_back(begin, end);
    begin = end + 1;
  }
  return FiberNames(std::move(names));
}

FiberNames broadcast_names(const Communicator& ranks, const FiberNames& names) {
  const std::vector<char> text = ranks.broadcast(text_of_names(names));
  return ranks.rank() == 0 ? names : names_in_text(text);
}

}  // namespace fiber
