// What rods do does not depend on where they are and how they lie: energies and forces are the
// same after any rigid motion, and none is damped.

#include <gtest/gtest.h>

#include <functional>

#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"

namespace fiber::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A rotation by up to half a turn about any axis, and a translation.
Isometry3d random_rigid_motion(Random& random) {
  Isometry3d motion = Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(random.uniform(0.0, M_PI), random.direction()));
  motion.pretranslate(random.in_cube(3.0));
  return motion;
}

/// The same rods elsewhere, with all the vectors that they have.
Rods placed(Rods rods, const Isometry3d& motion) {
  for (Vector3d& position : rods.positions) {
    position = motion * position;
  }
  for (auto* vectors : {&rods.velocities, &rods.directors, &rods.start_tangents}) {
    for (Vector3d& vector : *vectors) {
      vector = motion.linear() * vector;
    }
  }
  return rods;
}

/// A small rotation that rods make in the course of a step, which began with other directors.
void turn_in_step(Rods& rods, const Eigen::AngleAxisd& rotation) {
  std::vector<Vector3d> material_directions;
  for (std::uint32_t i = 0; i + 1 < rods.directors.size(); ++i) {
    material_directions.push_back(
        CrossSection(edge_direction(rods, i).tangent, current_director(rods, i), rods.angles[i])
            .first);
  }
  for (Vector3d& position : rods.positions) {
    position = rotation * position;
  }
  for (std::uint32_t i = 0; i + 1 < rods.directors.size(); ++i) {
    const double angle = signed_angle(current_director(rods, i), rotation * material_directions[i],
                                      edge_direction(rods, i).tangent);
    rods.angles[i] = nearest_turn(angle, rods.angles[i]);
  }
}

/// Turns rods by an angle about an axis, with their cross-sections.
void turn_in_step(Rods& rods, const Vector3d& axis, double angle) {
  constexpr int parts = 40;  // so that no director turns by half a turn in one of them
  for (int i = 0; i < parts; ++i) {
    turn_in_step(rods, Eigen::AngleAxisd(angle / parts, axis));
  }
}

struct ObjectivityCase {
  const char* name;
  bool has_twist;
  std::function<std::unique_ptr<Effect>(Rods&)> make;
};

std::ostream& operator<<(std::ostream& out, const ObjectivityCase& objectivity_case) {
  return out << objectivity_case.name;
}

template <class E, class... Arguments>
std::function<std::unique_ptr<Effect>(Rods&)> maker(const Arguments&... arguments) {
  return [=](Rods& /*rods*/) { return std::make_unique<E>(arguments...); };
}

std::unique_ptr<Effect> bend_with_sizes(Rods& rods) {
  rods.natural_curvatures.assign(rods.positions.size(), 1.5);
  return std::make_unique<Bend>();
}

std::unique_ptr<Effect> bend_with_sides(Rods& rods) {
  rods.natural_curvature_vectors.assign(rods.positions.size(), {1.0, -2.0});
  return std::make_unique<Bend>();
}

std::unique_ptr<Effect> bend_with_a_stiff_side(Rods& rods) {
  rods.natural_curvature_vectors.assign(rods.positions.size(), {1.0, -2.0});
  rods.stiff_sides.assign(rods.positions.size(), {3.0, {0.6, 0.8}});
  return std::make_unique<AnisotropicBend>();
}

std::unique_ptr<Effect> damping_of_a_stiff_side(Rods& rods) {
  rods.stiff_sides.assign(rods.positions.size(), {3.0, {0.6, 0.8}});
  return std::make_unique<AnisotropicDamping>(std::make_shared<Damping>(0.1));
}

class ObjectivityTest : public testing::TestWithParam<ObjectivityCase> {
 protected:
  /// Two earlier states, and the rods in a third one.
  void begin(Random& random) {
    rods_ = random_rods(random);
    if (GetParam().has_twist) {
      twist_ = std::make_unique<Twist>(rods_);
    }
    effect_ = GetParam().make(rods_);
    displace(rods_, random, 0.03, 0.5);
    first_ = rods_.state();
    displace(rods_, random, 0.03, 0.5);
    second_ = rods_.state();
    effect_->begin_step(rods_, {0.0, 0.01, {{{&second_, 4.0 / 3.0}, {&first_, -1.0 / 3.0}}}});
    displace(rods_, random, 0.03, 0.5);
  }

  Rods rods_;
  RodState first_;
  RodState second_;
  std::unique_ptr<Twist> twist_;
  std::unique_ptr<Effect> effect_;
};

TEST_P(ObjectivityTest, EnergiesAndForcesMoveWithTheRods) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 30; ++round) {
    begin(random);
    const Isometry3d motion = random_rigid_motion(random);
    const Rods elsewhere = placed(rods_, motion);
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      const double energy = energy_of(*effect_, rods_, rod);
      ASSERT_NEAR(energy_of(*effect_, elsewhere, rod), energy, 1e-11 * (1.0 + energy));
      const Eigen::VectorXd here = derivatives_of(*effect_, rods_, rod).gradient;
      const Eigen::VectorXd there = derivatives_of(*effect_, elsewhere, rod).gradient;
      const double allowed = 1e-11 * (1.0 + here.norm());
      const std::uint32_t unknowns = unknowns_of(rods_);
      for (Eigen::Index i = 0; i < here.size(); i += unknowns) {
        const Vector3d expected = motion.linear() * here.segment<3>(i);
        ASSERT_LE((there.segment<3>(i) - expected).norm(), allowed) << "round " << round;
        if (unknowns == 4) {
          ASSERT_NEAR(there[i + 3], here[i + 3], allowed) << "round " << round;
        }
      }
    }
  }
}

/// Directors turn about the tangent as the rods move in a step: their angles make up for it.
TEST_P(ObjectivityTest, EnergiesDoNotChangeWhereRodsTurnInAStep) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 30; ++round) {
    begin(random);
    Rods turned = rods_;
    turn_in_step(turned, random.direction(), random.uniform(0.0, 2.0));
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      const double energy = energy_of(*effect_, rods_, rod);
      ASSERT_NEAR(energy_of(*effect_, turned, rod), energy, 1e-10 * (1.0 + energy))
          << "round " << round;
    }
  }
}

const auto name_of_case = [](const auto& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    Effects, ObjectivityTest,
    testing::Values(
        ObjectivityCase{"stretch", false, maker<Stretch>()},
        ObjectivityCase{"inextensible", false,
                        [](Rods& rods) { return std::make_unique<Inextensible>(rods); }},
        ObjectivityCase{"bend", false, maker<Bend>()},
        ObjectivityCase{"bend_with_sizes", false, bend_with_sizes},
        ObjectivityCase{"bend_with_sides", true, bend_with_sides},
        ObjectivityCase{"bend_with_a_stiff_side", true, bend_with_a_stiff_side},
        ObjectivityCase{"twist", true, [](Rods& rods) { return std::make_unique<Twist>(rods); }},
        ObjectivityCase{"damping", false, maker<Damping>(0.1)},
        ObjectivityCase{"damping_with_twist", true, maker<Damping>(0.1)},
        ObjectivityCase{"damping_of_a_stiff_side", true, damping_of_a_stiff_side}),
    name_of_case);

/// Rods in three states of a rigid motion: in a step between them, nothing is lost.
TEST(Damping, LosesNothingInRigidMotion) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (int round = 0; round < 100; ++round) {
    Rods rods = random_rods(random);
    const bool has_twist = round % 2 == 0;
    const auto twist = has_twist ? std::make_unique<Twist>(rods) : nullptr;
    displace(rods, random, 0.05, 1.0);
    const Vector3d axis =
        round % 4 < 2 ? random.direction() : edge_direction(rods, rods.first(2)).tangent;
    const double angle = random.uniform(0.0, 1.0);
    const double ratio = random.uniform(0.5, 3.0);  // of the last step to the one before
    const Vector3d way = random.in_cube();
    const auto move = [&](double share) {
      turn_in_step(rods, axis, share * angle);
      for (Vector3d& position : rods.positions) {
        position += share * way;
      }
    };
    const RodState first = rods.state();
    move(1.0 / ratio);
    const RodState second = rods.state();
    const double share = 1.0 / (1.0 + 2.0 * ratio);
    if (has_twist) {
      rods.stiff_sides.assign(rods.positions.size(), {3.0, {0.6, 0.8}});
    }
    const auto damping = std::make_shared<Damping>(0.1);
    Damping of_bdf2(0.1);
    AnisotropicDamping to_side_of_bdf2(damping);
    for (Effect* const effect : std::initializer_list<Effect*>{&of_bdf2, &to_side_of_bdf2}) {
      effect->begin_step(
          rods,
          {0.0,
           0.01 * share * (1.0 + ratio),
           {{{&second, (1.0 + ratio) * (1.0 + ratio) * share}, {&first, -ratio * ratio * share}}}});
    }
    Damping of_euler(0.1);
    AnisotropicDamping to_side_of_euler(damping);
    of_euler.begin_step(rods, {0.0, 0.01});
    to_side_of_euler.begin_step(rods, {0.0, 0.01});
    move(1.0);
    for (const Effect* const effect : std::initializer_list<const Effect*>{
             &of_bdf2, &of_euler, &to_side_of_bdf2, &to_side_of_euler}) {
      EXPECT_LE(energy_of(*effect, rods), 1e-20) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace fiber::test
