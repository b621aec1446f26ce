#include "src/hierarchy/fiber_order.hpp"

#include <stdexcept>
#include <string>

namespace fiber {

std::vector<std::uint32_t> end_point_connected_order(const std::vector<std::uint32_t>& offsets) {
  std::vector<std::uint32_t> order;
  order.reserve(offsets.back() - (offsets.size() - 1));
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    const std::uint32_t begin = offsets[fiber];
    const std::uint32_t end = offsets[fiber + 1] - 1;  // the last point starts no segment
    const bool backwards = fiber % 2 == 1;
    for (std::uint32_t i = 0; i < end - begin; ++i) {
      order.push_back(backwards ? end - 1 - i : begin + i);
    }
  }
  return order;
}

std::vector<std::uint32_t> threading_order(const std::vector<std::uint32_t>& offsets) {
  const std::size_t fiber_count = offsets.size() - 1;
  std::vector<std::uint32_t> order;
  if (fiber_count == 0) {
    return order;
  }
  const std::uint32_t segments = offsets[1] - offsets[0] - 1;
  for (std::size_t fiber = 0; fiber < fiber_count; ++fiber) {
    const std::uint32_t own = offsets[fiber + 1] - offsets[fiber] - 1;
    if (own != segments) {
      throw std::invalid_argument("fibre " + std::to_string(fiber) + " has " + std::to_string(own) +
                                  " segment(s), fibre 0 has " + std::to_string(segments) +
                                  "; threading needs the same number in all fibres");
    }
  }
  order.reserve(fiber_count * segments);
  for (std::uint32_t segment = 0; segment < segments; ++segment) {
    for (std::size_t fiber = 0; fiber < fiber_count; ++fiber) {
      order.push_back(offsets[fiber] + segment);
    }
  }
  return order;
}

}  // namespace fiber
