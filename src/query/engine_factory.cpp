#include <mutex>
#include <stdexcept>
#include <utility>

#include "src/query/brute_force.hpp"
#include "src/query/run_tree_engine.hpp"
#include "src/query/threads.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// Families in the order in which they were registered.
struct Registry {
  std::mutex mutex;
  std::vector<EngineFamily> families;
};

/// Never taken apart: libraries that are unloaded late may still ask.
Registry& registry() {
  static auto* const all = new Registry;  // NOLINT(cppcoreguidelines-owning-memory)
  return *all;
}

std::vector<EngineFamily> families() {
  const std::lock_guard<std::mutex> lock(registry().mutex);
  return registry().families;
}

}  // namespace

bool register_engines(EngineFamily family) {
  const std::lock_guard<std::mutex> lock(registry().mutex);
  registry().families.push_back(std::move(family));
  return true;
}

std::unique_ptr<ProximityEngine> make_engine(const std::string& name,
                                             const EngineOptions& options) {
  validate_threads(options.threads);  // also where the engine has one thread
  if (name == "run_tree") {
    return std::make_unique<RunTreeEngine>(options);
  }
  if (name == "brute_force") {
    return std::make_unique<BruteForceEngine>();
  }
  std::string reason;
  std::string others;
  for (const EngineFamily& family : families()) {
    try {
      if (std::unique_ptr<ProximityEngine> engine = family.make(name, options)) {
        return engine;
      }
    } catch (const std::invalid_argument& error) {
      reason = std::string(" (") + error.what() + ")";
    }
    others += family.other_names.empty() ? "" : "; " + family.other_names;
  }
  throw std::invalid_argument("unknown engine " + quote(name) + reason +
                              ", known are: " + join(engine_names()) + others);
}

std::vector<std::string> engine_names() {
  std::vector<std::string> names{"run_tree"};
  for (const EngineFamily& family : families()) {
    names.insert(names.end(), family.names.begin(), family.names.end());
  }
  names.emplace_back("brute_force");
  return names;
}

}  // namespace fiber
