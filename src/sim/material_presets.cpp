#include <map>
#include <stdexcept>

#include "fiber_proximity/sim/material.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

const std::map<std::string, RodMaterial>& presets() {
  static const std::map<std::string, RodMaterial> presets{
      // Keratin.
      {"hair", {3.9e9, 1.5e9, 1320.0, 1.0}},
      // Stranded copper in PVC, 3 x 1.5 mm² in 8 mm: the strands carry the tension.
      {"power_cable", {1.0e10, 4.0e7, 2200.0, 0.01}},
      // Braided polyamide.
      {"rope", {9.0e8, 2.0e6, 800.0, 0.001}},
      // Shore A 50, taken as solid.
      {"silicone_tube", {2.5e6, 8.4e5, 1150.0, 1.0}},
  };
  return presets;
}

}  // namespace

RodMaterial material_preset(const std::string& name) {
  const auto found = presets().find(name);
  if (found != presets().end()) {
    return found->second;
  }
  throw std::invalid_argument("there is no material " + quote(name) +
                              ", known are: " + join(material_names()));
}

std::vector<std::string> material_names() {
  std::vector<std::string> names;
  for (const auto& [name, material] : presets()) {
    names.push_back(name);
  }
  return names;
}

}  // namespace fiber
