#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// The scene on which effects are weighed: cables in two layers that cross, just above a table.
struct EffectScene {
  std::uint32_t cables = 20;
  std::uint32_t segments = 60;  ///< of each
  std::uint32_t substeps = 4;   ///< steps of a frame of 1/60 s
  std::uint32_t frames = 60;    ///< to measure, after a quarter as many
  std::uint32_t threads = 1;    ///< 0 for as many as there are cores
};

/// A simulation of it with what is named as scene files name it: effects; `ball` and `weld`, kinds
/// of joints, for cables of two halves that are joined in the middle; and keys, `sections` for
/// parts that are stiffer, `motion` for a table that rises, `restitution` for one that throws
/// cables back.
class EffectSimulation {
 public:
  EffectSimulation(const EffectScene& scene, const std::vector<std::string>& effects);

  /// @param frames of 1/60 s
  void run(std::uint32_t frames);

  const Rods& rods() const { return stepper_->rods(); }

 private:
  bool has(const std::string& name) const;
  Effects make_effects(Rods& rods) const;
  std::unique_ptr<Contacts> make_contacts() const;

  std::vector<std::string> names_;
  std::uint32_t substeps_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace fiber
