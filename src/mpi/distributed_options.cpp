#include "src/mpi/distributed_options.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace fiber {
namespace {

struct Field {
  const char* name;
  double value;
};

void require_same(const Communicator& ranks, const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    // Before this all ranks have the same text for an error.
    if (ranks.min(field.value) != ranks.max(field.value)) {
      throw std::invalid_argument(std::string(field.name) +
                                  " is not the same on all ranks, it must be");
    }
  }
}

void require_same(const Communicator& ranks, const PairOptions& options) {
  constexpr double none = -1.0;  // as no field may be
  require_same(ranks,
               {{"margin", options.margin},
                {"max_contacts", static_cast<double>(options.max_contacts)},
                {"contact_limit", static_cast<double>(options.contact_limit)},
                {"pair_limit", static_cast<double>(options.pair_limit)},
                {"deadline", options.deadline},
                {"pairing", static_cast<double>(options.pairing)},
                {"neighbour_skip",
                 options.neighbour_skip ? static_cast<double>(*options.neighbour_skip) : none},
                {"neighbour_skip_length", options.neighbour_skip_length.value_or(none)}});
}

}  // namespace

void require_distributed_options(const Communicator& ranks, const QueryOptions& options) {
  ranks.throw_on_all(error_in([&] { validate(options); }));
  require_same(ranks, {{"type", static_cast<double>(options.type)},
                       {"kernel", static_cast<double>(options.kernel)}});
  require_same(ranks, static_cast<const PairOptions&>(options));
}

void require_distributed_options(const Communicator& ranks, const MotionOptions& options) {
  ranks.throw_on_all(error_in([&] { validate(options); }));
  require_same(ranks, {{"type", static_cast<double>(options.type)},
                       {"tolerance", options.tolerance},
                       {"time_tolerance", options.time_tolerance}});
  require_same(ranks, static_cast<const PairOptions&>(options));
}

}  // namespace fiber
