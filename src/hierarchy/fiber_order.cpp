#include "fiber_proximity/hierarchy/fiber_order.hpp"

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

}  // namespace fiber
