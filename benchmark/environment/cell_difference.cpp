#include "benchmark/environment/cell_difference.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fiber {
namespace {

/// Of two distances [m], as far as they can be compared: without being asked for more, FCL does not
/// tell how deep a penetration is.
double difference(double x, double y) { return std::abs(std::max(x, 0.0) - std::max(y, 0.0)); }

auto key(const FoundPair& pair) { return std::tie(pair.a, pair.b); }

}  // namespace

void sort_pairs(std::vector<FoundPair>& pairs) {
  std::sort(pairs.begin(), pairs.end(),
            [](const FoundPair& x, const FoundPair& y) { return key(x) < key(y); });
}

void CellDifference::add(const CellAnswer& wanted, const CellAnswer& given) {
  compare(wanted.self_contacts, given.self_contacts);
  compare(wanted.contacts, given.contacts);
  nearest_error_ = std::max(nearest_error_, difference(wanted.nearest, given.nearest));
}

/// Both are sorted.
void CellDifference::compare(const std::vector<FoundPair>& wanted,
                             const std::vector<FoundPair>& given) {
  auto x = wanted.begin();
  auto y = given.begin();
  while (x != wanted.end() && y != given.end()) {
    if (key(*x) == key(*y)) {
      distance_error_ = std::max(distance_error_, difference(x->distance, y->distance));
      ++x;
      ++y;
    } else if (key(*x) < key(*y)) {
      ++missed_;
      ++x;
    } else {
      ++unwanted_;
      ++y;
    }
  }
  missed_ += static_cast<std::uint64_t>(wanted.end() - x);
  unwanted_ += static_cast<std::uint64_t>(given.end() - y);
}

}  // namespace fiber
