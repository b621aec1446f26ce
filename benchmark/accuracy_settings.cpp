#include "benchmark/accuracy_settings.hpp"

#include <limits>

namespace fiber {

std::vector<AccuracySetting> accuracy_settings(double radius) {
  struct Query {
    const char* name;
    QueryType type;
    double margin;
  };
  std::vector<AccuracySetting> settings;
  for (const Query& query :
       {Query{"contacts", QueryType::ALL, 0.0},
        Query{"closest", QueryType::CLOSEST, std::numeric_limits<double>::infinity()},
        Query{"fiber_pairs", QueryType::FIBER_PAIRS, 2.0 * radius}}) {
    AccuracySetting reference{query.name, "robust", {}, 0.0, true};
    reference.options.type = query.type;
    reference.options.margin = query.margin;
    settings.push_back(reference);
    AccuracySetting setting = reference;
    setting.is_reference = false;
    setting.name = name_of(Kernel::EXACT);
    setting.options.kernel = Kernel::EXACT;
    settings.push_back(setting);
    setting.options.kernel = Kernel::ROBUST;
    for (const double part : {0.01, 0.1, 1.0}) {
      if (query.type == QueryType::ALL) {
        continue;  // looks for all pairs within the margin anyway
      }
      setting.name = "tolerance of " + std::to_string(part).substr(0, 4) + " radii";
      setting.options.tolerance = part * radius;
      settings.push_back(setting);
    }
    setting.options.tolerance = 0.0;
    for (const double part : {0.25, 0.5, 0.75}) {
      setting.name = "deadline at " + std::to_string(part).substr(0, 4);
      setting.deadline_part = part;
      settings.push_back(setting);
    }
  }
  return settings;
}

}  // namespace fiber
