#include "fiber_proximity/query/options.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace fiber {

void validate(const QueryOptions& options) {
  if (!(options.margin >= 0.0)) {
    throw std::invalid_argument("margin is " + std::to_string(options.margin) +
                                ", it must be at least 0 m (infinity for no limit)");
  }
  if (!(options.neighbour_skip_length >= 0.0)) {
    throw std::invalid_argument("neighbour_skip_length is " +
                                std::to_string(options.neighbour_skip_length) +
                                ", it must be at least 0 m");
  }
  if (options.type == QueryType::LIMITED && options.max_contacts == 0) {
    throw std::invalid_argument("max_contacts is 0, a limited query needs at least 1");
  }
}

QueryType query_type_from_name(const std::string& name) {
  static const std::array<std::pair<const char*, QueryType>, 5> types{
      {{"first", QueryType::FIRST},
       {"closest", QueryType::CLOSEST},
       {"limited", QueryType::LIMITED},
       {"all", QueryType::ALL},
       {"fiber_pairs", QueryType::FIBER_PAIRS}}};
  for (const auto& [type_name, type] : types) {
    if (name == type_name) {
      return type;
    }
  }
  throw std::invalid_argument("unknown query type '" + name +
                              "', known are: first, closest, limited, all, fiber_pairs");
}

}  // namespace fiber
