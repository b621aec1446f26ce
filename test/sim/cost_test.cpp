// Effects that a scene does not name take neither memory nor calls. Counts allocations and calls,
// not time.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/cost_scenes.hpp"
#include "test/sim/counted_memory.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

using MakeContacts = std::function<std::unique_ptr<Contacts>()>;

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

}  // namespace
}  // namespace fiber::test
