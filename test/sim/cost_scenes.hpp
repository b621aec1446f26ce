#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {

constexpr double step = 1.0 / 240.0;  // [s]

/// Parallel rods, each at this distance above the one before.
inline Rods stacked(int count, int segments, double distance) {
  Rods rods;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d start(0.0, 0.0, 0.1 + i * distance);
    rods.add(straight(start, start + Eigen::Vector3d(0.5, 0.1 * i, 0.0), segments), 0.005,
             rubber(0.005));
  }
  return rods;
}

inline StepperOptions one_thread() {
  StepperOptions options;
  options.threads = 1;
  return options;
}

using MakeEffects = std::function<Effects(Rods& rods)>;

inline Effects base(Rods& /*rods*/) { return elastic(standard_gravity); }

/// Gravity, stretch and bend, and one effect more.
template <class Make>
MakeEffects base_and(const Make& make) {
  return [make](Rods& rods) {
    Effects effects = base(rods);
    effects.push_back(make(rods));
    return effects;
  };
}

struct NamedEffect {
  const char* name;
  MakeEffects make;
};

inline std::vector<NamedEffect> effects_with_state() {
  return {
      {"twist", base_and([](Rods& rods) { return std::make_unique<Twist>(rods); })},
      {"damping", base_and([](Rods&) { return std::make_unique<Damping>(0.01); })},
      {"drag", base_and([](Rods&) { return std::make_unique<Drag>(Drag::Options{}); })},
      {"plasticity", base_and([](Rods& rods) {
         return std::make_unique<Plasticity>(rods, Plasticity::Options{});
       })},
      {"inextensible", base_and([](Rods& rods) { return std::make_unique<Inextensible>(rods); })},
      {"attachment",
       base_and([](Rods& rods) { return hold(rods, {pin(0, rods.positions.front())}); })},
      {"load", base_and([](Rods& rods) {
         auto loads = std::make_unique<Loads>();
         Loads::Load load;
         load.part = RodPart{0.1, 0.4};
         load.force =
             TimeTable<Eigen::Vector3d>({{0.0, {0.0, 0.0, 0.0}}, {1.0, {0.0, 0.1, 0.0}}}, true);
         loads->add(rods, load);
         return loads;
       })},
  };
}

}  // namespace fiber::test
