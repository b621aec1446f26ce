#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fiber {

// Lists of values as bytes, on their way to another rank: how many there are, then the values as
// they are in memory.

template <class List>
void pack(std::vector<char>& bytes, const List& values) {
  const std::uint64_t count = values.size();
  const auto append = [&bytes](const void* data, std::size_t size) {
    const auto* const begin = static_cast<const char*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  append(&count, sizeof count);
  append(values.data(), count * sizeof *values.data());
}

/// @param next where pack() has put the list; moves on to the one after it
template <class List>
List unpack(const char*& next) {
  const auto take = [&next](void* data, std::size_t size) {
    std::copy_n(next, size, static_cast<char*>(data));
    next += size;
  };
  std::uint64_t count = 0;
  take(&count, sizeof count);
  List values;
  values.resize(count);
  take(values.data(), count * sizeof *values.data());
  return values;
}

}  // namespace fiber
