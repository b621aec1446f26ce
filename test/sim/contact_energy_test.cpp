// Energy where the normals of contacts turn on the way of a step: of rods that slide and roll over
// each other and over a post.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <string>

#include "test/sim/random_rods.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double sliding_radius = 0.004;
constexpr double simulated_time = 0.4;
constexpr int table_scenes = 4;
constexpr int post_scenes = 16;  // which rods soon fall off

struct Sliding {
  std::optional<double> friction;  // coefficient
  bool has_twist;
  bool has_post;  // below, in place of a table
  double steps_per_second;
};

std::ostream& operator<<(std::ostream& out, const Sliding& sliding) {
  return out << (sliding.friction ? "friction" : "no_friction")
             << (sliding.has_twist ? "_twist" : "") << (sliding.has_post ? "_post" : "_table")
             << '_' << sliding.steps_per_second;
}

/// Rods above each other, straight and in all directions, that fly and fall.
Rods flying_rods(Random& random, int count) {
  Rods rods;
  for (int rod = 0; rod < count; ++rod) {
    const double turn = random.uniform(0.0, 2.0 * M_PI);
    const Vector3d along(0.12 * std::cos(turn), 0.12 * std::sin(turn), random.uniform(-0.01, 0.01));
    const Vector3d middle(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                          0.06 + 0.03 * rod);
    const char* const material = random.integer(0, 1) == 0 ? "silicone_tube" : "power_cable";
    rods.add(straight(middle - along, middle + along, random.integer(8, 20)), sliding_radius,
             solid_round_section(material_preset(material), sliding_radius));
    const Vector3d velocity = random.in_cube(1.0) - Vector3d::UnitZ();
    std::fill(rods.velocities.begin() + rods.first(rod), rods.velocities.end(), velocity);
  }
  return rods;
}

std::shared_ptr<const Environment> below(bool has_post) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitX()).toRotationMatrix();
  return has_post ? environment_of(CapsuleShape{0.004, 1.0}, pose)
                  : environment_of(HalfSpaceShape{});
}

class ContactEnergy : public testing::TestWithParam<Sliding> {};

/// The normal of the end of a step points along the way there: without what takes that back, single
/// steps of these gain up to 3 % of all energy.
TEST_P(ContactEnergy, ImplicitEulerGainsNoneWhereNormalsTurn) {
  const Sliding& sliding = GetParam();
  SCOPED_TRACE(seed_message());
  Random random;
  int in_contact = 0;
  int balanced = 0;
  std::uint32_t midpoint_contacts = 0;
  int steps = 0;
  for (int round = 0; round < rounds(sliding.has_post ? post_scenes : table_scenes); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Rods rods = flying_rods(random, sliding.has_post ? 2 : 4);
    double scale = kinetic_energy(rods);
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      scale += rods.masses[i] * standard_gravity * rods.positions[i].z();
    }
    Effects all = elastic(standard_gravity);
    if (sliding.has_twist) {
      all.push_back(std::make_unique<Twist>(rods));
    }
    StepperOptions options;
    options.threads = 1;
    Stepper stepper(rods, std::move(all), options,
                    contacts_with(below(sliding.has_post), sliding.friction));
    while (stepper.time() < simulated_time) {
      stepper.step(1.0 / sliding.steps_per_second);
      if (stepper.report().unbalanced == 0) {
        ASSERT_LE(stepper.report().energy_gain, 1e-7 * scale) << "at " << stepper.time() << " s";
        ++balanced;
      }
      midpoint_contacts += stepper.report().midpoint_contacts;
      in_contact += stepper.forces().contacts.empty() ? 0 : 1;
      ++steps;
    }
  }
  EXPECT_GE(balanced, 0.9 * steps);
  // Elsewhere few steps would gain any, or none.
  if (!sliding.friction && sliding.steps_per_second == (sliding.has_post ? 960.0 : 240.0)) {
    expect_enough(midpoint_contacts, 1U);
  }
  expect_enough(in_contact, steps / (sliding.has_post ? 20 : 3));
}

std::vector<Sliding> all_kinds() {
  std::vector<Sliding> kinds;
  for (const std::optional<double> friction :
       {std::optional<double>(), std::optional<double>(0.3)}) {
    for (const bool has_twist : {false, true}) {
      for (const bool has_post : {false, true}) {
        for (const double steps_per_second : {60.0, 240.0, 960.0}) {
          kinds.push_back({friction, has_twist, has_post, steps_per_second});
        }
      }
    }
  }
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ContactEnergy, testing::ValuesIn(all_kinds()),
                         [](const auto& sliding) { return testing::PrintToString(sliding.param); });

}  // namespace
}  // namespace fiber::test
