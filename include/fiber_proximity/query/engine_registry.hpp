#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Engines that make_engine() can make, beside those of this library.
struct EngineFamily {
  /// What engine_names() lists, in this order.
  std::vector<std::string> names;

  /// Makes the engine of a name: one of `names`, or another that the family knows.
  /// @return nullptr for a name that is none of the family's
  /// @throws std::invalid_argument for a name that would be one but for a number in it, saying why
  std::function<std::unique_ptr<ProximityEngine>(const std::string& name,
                                                 const EngineOptions& options)>
      make;

  /// The other names it knows, as an error message lists them; may be empty.
  std::string other_names;
};

/// Adds a family, for the rest of the process. A library calls this when it is loaded, so that its
/// engines are there for whoever links it. Safe from several threads.
/// @return true, so that the initialiser of a static variable can call it
bool register_engines(EngineFamily family);

}  // namespace fiber
