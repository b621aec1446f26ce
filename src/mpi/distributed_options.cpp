#include "src/mpi/distributed_options.hpp"

#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace fiber {
namespace {

/// "" if such a query can be answered.
std::string error_of(const QueryOptions& options) {
  try {
    validate(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  if (options.type != QueryType::ALL) {
    return "a query over several ranks must be of type all, other types are not supported yet";
  }
  if (options.deadline > 0.0) {
    return "deadline is " + std::to_string(options.deadline) +
           " s, a query over several ranks has none: it must be 0";
  }
  for (const auto& [name, value] :
       {std::pair("contact_limit", std::uint64_t{options.contact_limit}),
        std::pair("pair_limit", options.pair_limit)}) {
    if (value > 0) {
      return std::string(name) + " is " + std::to_string(value) +
             ", a query over several ranks has none: it must be 0";
    }
  }
  return "";
}

}  // namespace

void require_distributed_options(const Communicator& ranks, const QueryOptions& options) {
  ranks.agree(error_of(options));
  struct Field {
    const char* name;
    double value;
  };
  constexpr double none = -1.0;  // as no field may be
  const std::array<Field, 5> fields{
      {{"margin", options.margin},
       {"pairing", static_cast<double>(options.pairing)},
       {"kernel", static_cast<double>(options.kernel)},
       {"neighbour_skip",
        options.neighbour_skip ? static_cast<double>(*options.neighbour_skip) : none},
       {"neighbour_skip_length", options.neighbour_skip_length.value_or(none)}}};
  for (const Field& field : fields) {
    // Before this all ranks have the same text for an error.
    if (ranks.smallest(field.value) != ranks.largest(field.value)) {
      throw std::invalid_argument(std::string(field.name) +
                                  " is not the same on all ranks, it must be");
    }
  }
}

}  // namespace fiber
