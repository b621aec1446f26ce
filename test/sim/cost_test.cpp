// Effects that a scene does not name take neither memory nor calls. Counts allocations and calls,
// not time.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <new>
#include <ostream>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> bytes{0};
}  // namespace

// Counts every allocation of this process by new, which leaves out those of Eigen's own. GCC
// inlines one half of the pair and then believes that new and free are mixed.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void* operator new(std::size_t size) {
  ++allocations;
  bytes += size;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  bytes += size;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double step = 1.0 / 240.0;

/// The requests to operator new.
struct Memory {
  std::size_t allocations = 0;
  std::size_t bytes = 0;

  bool operator==(const Memory& other) const {
    return allocations == other.allocations && bytes == other.bytes;
  }
};

std::ostream& operator<<(std::ostream& out, const Memory& memory) {
  return out << memory.allocations << " allocations of " << memory.bytes << " bytes";
}

template <class Call>
Memory memory_of(const Call& call) {
  const Memory before{allocations, bytes};
  call();
  return {allocations - before.allocations, bytes - before.bytes};
}

/// Parallel rods, each at this distance above the one before.
Rods stacked(int count, int segments, double distance) {
  Rods rods;
  for (int i = 0; i < count; ++i) {
    const Vector3d start(0.0, 0.0, 0.1 + i * distance);
    rods.add(straight(start, start + Vector3d(0.5, 0.1 * i, 0.0), segments), 0.005, rubber(0.005));
  }
  return rods;
}

StepperOptions one_thread() {
  StepperOptions options;
  options.threads = 1;
  return options;
}

using MakeEffects = std::function<Effects(Rods& rods)>;
using MakeContacts = std::function<std::unique_ptr<Contacts>()>;

Effects base(Rods& /*rods*/) { return elastic(standard_gravity); }
std::unique_ptr<Contacts> no_contacts() { return nullptr; }

/// Makes a simulation and some steps of it.
void simulate(Rods rods, const MakeEffects& make_effects,
              const MakeContacts& make_contacts = no_contacts) {
  Effects effects = make_effects(rods);
  Stepper stepper(std::move(rods), std::move(effects), one_thread(), make_contacts());
  for (int i = 0; i < 20; ++i) {
    stepper.step(step);
  }
}

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

std::vector<NamedEffect> effects_with_state() {
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
         load.force = TimeTable<Vector3d>({{0.0, {0.0, 0.0, 0.0}}, {1.0, {0.0, 0.1, 0.0}}}, true);
         loads->add(rods, load);
         return loads;
       })},
  };
}

MakeContacts contacts_of_everything() {
  return [] { return contacts_with(environment_of(HalfSpaceShape{}), 0.3); };
}

/// Whatever else the program makes of effects that a scene does not name.
/// What a scene takes that joins nothing, whatever others there are.
TEST(Cost, JointsOfOtherScenesCostNothing) {
  const auto unjoined = [] { return memory_of([] { simulate(stacked(6, 12, 0.1), base); }); };
  unjoined();  // what is made once for all
  const Memory before = unjoined();
  Rods rods = stacked(1, 12, 0.1);
  rods.add(straight(rods.positions.back(), {1.0, 0.0, 0.0}, 12), 0.005, rubber(0.005));
  auto joints = std::make_unique<Joints>(Joints::Options{});
  joints->add(rods, {Joints::Kind::WELD, {{0, 12}, {1, 0}}});
  Stepper stepper(std::move(rods), elastic(standard_gravity), one_thread(), nullptr,
                  std::move(joints));
  stepper.step(step);
  EXPECT_EQ(unjoined(), before);
  EXPECT_TRUE(stacked(1, 12, 0.1).joints.empty());
  EXPECT_TRUE(stacked(1, 12, 0.1).closed.empty());
}

TEST(Cost, OfAnEffectThatAnotherSceneNamesIsNothing) {
  const auto plain = [] { simulate(stacked(3, 20, 0.1), base); };
  plain();  // threads and the like are made once
  const Memory alone = memory_of(plain);
  EXPECT_GT(alone.bytes, 0U);
  Rods rods = stacked(3, 20, 0.1);
  Effects all = elastic(standard_gravity);
  for (const NamedEffect& effect : effects_with_state()) {
    for (auto& each : effect.make(rods)) {
      all.push_back(std::move(each));
    }
  }
  Stepper other(rods, std::move(all), one_thread(), contacts_of_everything()());
  other.step(step);
  EXPECT_EQ(memory_of(plain), alone);
}

/// Shows that the counts above would have seen it.
TEST(Cost, OfAnEffectThatTheSceneNamesIsThere) {
  const int count = 3;
  const Memory without = memory_of([=] { simulate(stacked(count, 20, 0.1), base); });
  for (const NamedEffect& effect : effects_with_state()) {
    const Memory with = memory_of([&] { simulate(stacked(count, 20, 0.1), effect.make); });
    EXPECT_GT(with.bytes, without.bytes) << effect.name;
    EXPECT_GT(with.allocations, without.allocations) << effect.name;
  }
  const Memory contacts =
      memory_of([=] { simulate(stacked(count, 20, 0.1), base, contacts_of_everything()); });
  EXPECT_GT(contacts.allocations, without.allocations);
}

/// No engine looks for what is near, nor are rods solved together.
TEST(Cost, OfRodsInEachOtherIsThatOfRodsApartWithoutContactEffects) {
  simulate(stacked(10, 20, 1.0), base);
  const Memory apart = memory_of([] { simulate(stacked(10, 20, 1.0), base); });
  const Memory touching = memory_of([] { simulate(stacked(10, 20, 0.001), base); });
  EXPECT_EQ(touching, apart);
  const auto with_contacts = [](double distance) {
    return memory_of([&] { simulate(stacked(10, 20, distance), base, contacts_of_everything()); });
  };
  EXPECT_GT(with_contacts(0.001).bytes, with_contacts(1.0).bytes) << "the counts would see it";
}

/// Counts how often it is called, and otherwise does nothing.
class Probe : public Effect {
 public:
  struct Calls {
    std::atomic<int> begin_step{0};
    std::atomic<int> energy{0};
    std::atomic<int> derivatives{0};
    std::atomic<int> end_step{0};
    std::atomic<std::uint32_t> unknowns{0};
  };

  explicit Probe(Calls& calls) : calls_(&calls) {}

  void begin_step(Rods& /*rods*/, const TimeStep& /*step*/) override { ++calls_->begin_step; }
  void energy(const RodPack& /*rods*/, const std::vector<SimdBatch>& /*values*/,
              SimdBatch& energy) const override {
    ++calls_->energy;
    energy = SimdBatch{};
  }
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                       PackSystem& system) const override {
    calls_->derivatives += static_cast<int>(rods.used);
    calls_->unknowns = static_cast<std::uint32_t>(system.unknowns);
  }
  void end_step(Rods& /*rods*/, const TimeStep& /*step*/) override { ++calls_->end_step; }

 private:
  Calls* calls_;
};

void simulate_probed(Probe::Calls& calls, bool with_twist) {
  simulate(stacked(2, 20, 0.1), [&](Rods& rods) {
    Effects effects = base(rods);
    effects.push_back(std::make_unique<Probe>(calls));
    if (with_twist) {
      effects.push_back(std::make_unique<Twist>(rods));
    }
    return effects;
  });
}

TEST(Cost, OnlyTwistAddsAnUnknown) {
  Probe::Calls without;
  simulate_probed(without, false);
  EXPECT_EQ(without.unknowns, 3U);
  Probe::Calls with;
  simulate_probed(with, true);
  EXPECT_EQ(with.unknowns, 4U);
}

/// So that what effects cost adds up: no effect has others called more often.
TEST(Cost, AnEffectIsCalledAsOftenWhateverElseIsThere) {
  Probe::Calls alone;
  Probe::Calls beside;
  Probe::Calls other;
  simulate(stacked(2, 20, 0.1), base_and([&](Rods&) { return std::make_unique<Probe>(alone); }));
  simulate(stacked(2, 20, 0.1), [&](Rods& rods) {
    Effects effects = base(rods);
    effects.push_back(std::make_unique<Probe>(beside));
    effects.push_back(std::make_unique<Probe>(other));
    return effects;
  });
  EXPECT_EQ(alone.begin_step, 20);
  EXPECT_EQ(alone.end_step, 20);
  EXPECT_GT(alone.energy, 0);
  EXPECT_GE(alone.derivatives, 2 * 20) << "each rod in each step";
  for (const Probe::Calls* calls : {&beside, &other}) {
    EXPECT_EQ(calls->begin_step, alone.begin_step);
    EXPECT_EQ(calls->energy, alone.energy);
    EXPECT_EQ(calls->derivatives, alone.derivatives);
    EXPECT_EQ(calls->end_step, alone.end_step);
  }
}

/// Allocations of twenty steps after twenty others.
std::size_t allocations_in_steady_state(Rods rods, const MakeEffects& make_effects) {
  Effects effects = make_effects(rods);
  Stepper stepper(std::move(rods), std::move(effects), one_thread());
  const auto run = [&] {
    for (int i = 0; i < 20; ++i) {
      stepper.step(step);
    }
  };
  run();
  return memory_of(run).allocations;
}

/// Memory for a step is that of the step before.
TEST(Cost, OfAStepInAllocationsIsNothing) {
  std::vector<NamedEffect> all = effects_with_state();
  all.push_back({"base", base});
  for (const NamedEffect& effect : all) {
    EXPECT_EQ(allocations_in_steady_state(stacked(4, 30, 0.1), effect.make), 0U) << effect.name;
  }
}

}  // namespace
}  // namespace fiber::test
