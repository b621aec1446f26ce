#include "src/mpi/distributed_options.hpp"

#include <array>
#include <stdexcept>
#include <string>

namespace fiber {
namespace {

/// "" if the options validate.
std::string error_of(const QueryOptions& options) {
  try {
    validate(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
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
  const std::array<Field, 10> fields{
      {{"type", static_cast<double>(options.type)},
       {"margin", options.margin},
       {"max_contacts", static_cast<double>(options.max_contacts)},
       {"contact_limit", static_cast<double>(options.contact_limit)},
       {"pair_limit", static_cast<double>(options.pair_limit)},
       {"deadline", options.deadline},
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
