// The simulation refuses wrong rods and effects with errors that name what is wrong.

#include "fiber_proximity/sim/rods.hpp"

#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

const RodSection rod_section{1e3, 1.0, 1.0, 1.0, 1e-4};
const std::vector<Vector3d> points = straight({0, 0, 0}, {1, 0, 0}, 4);

void expect_error(const std::function<void()>& function, const std::string& message) {
  EXPECT_EQ(error_of(function), message);
}

TEST(Rods, HaveMassesAndLengths) {
  Rods rods;
  rods.add(points, 0.01, rod_section);
  rods.add({{0, 0, 0}, {0, 0, 2}}, 0.01, rod_section);
  EXPECT_EQ(rods.count(), 2U);
  EXPECT_EQ(rods.offsets, (std::vector<std::uint32_t>{0, 5, 7}));
  EXPECT_EQ(rods.masses, (std::vector<double>{0.125, 0.25, 0.25, 0.25, 0.125, 1.0, 1.0}));
  EXPECT_EQ(rods.rest_lengths, (std::vector<double>{0.25, 0.25, 0.25, 0.25, 0.0, 2.0, 0.0}));
}

TEST(Rods, RefuseBadShapesAndStayAsTheyWere) {
  Rods rods;
  rods.add(points, 0.01, rod_section);
  const auto add = [&](const std::vector<Vector3d>& bad, double radius) {
    return [&rods, bad, radius] { rods.add(bad, radius, rod_section); };
  };
  expect_error(add({}, 0.01), "rod 1: has 0 point(s), it must have at least 2");
  expect_error(add({{0, 0, 0}}, 0.01), "rod 1: has 1 point(s), it must have at least 2");
  expect_error(add(points, 0.0), "rod 1: radius is 0.000000, it must be positive and finite");
  expect_error(add(points, -1.0), "rod 1: radius is -1.000000, it must be positive and finite");
  expect_error(add(points, nan), "rod 1: radius is nan, it must be positive and finite");
  expect_error(add({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, 0.01),
               "rod 1: edge 1 has no length: its points are the same");
  for (const double bad : {infinity, nan, 1e61}) {
    expect_error(add({{0, 0, 0}, {0, bad, 0}}, 0.01),
                 "rod 1: point 1 must be finite and at most 1e60 m");
  }
  EXPECT_EQ(rods.count(), 1U);
  EXPECT_EQ(rods.positions.size(), points.size());
  EXPECT_EQ(rods.offsets.size(), 2U);
}

TEST(Rods, RefuseBadSections) {
  struct Case {
    double RodSection::*value;
    const char* name;
    bool may_be_zero;
  };
  for (const Case& each : {Case{&RodSection::stretching_stiffness, "stretching_stiffness", false},
                           Case{&RodSection::bending_stiffness, "bending_stiffness", true},
                           Case{&RodSection::twisting_stiffness, "twisting_stiffness", true},
                           Case{&RodSection::mass_per_length, "mass_per_length", false},
                           Case{&RodSection::inertia_per_length, "inertia_per_length", true}}) {
    for (const double bad : {-1.0, nan, infinity, 0.0}) {
      Rods rods;
      RodSection changed = rod_section;
      changed.*each.value = bad;
      const std::string rule = each.may_be_zero ? "at least 0 and finite" : "positive and finite";
      const std::string expected =
          bad == 0.0 && each.may_be_zero
              ? "no error"
              : std::string(each.name) + " is " + std::to_string(bad) + ", it must be " + rule;
      expect_error([&] { rods.add(points, 0.01, changed); }, expected);
    }
  }
}

TEST(Rods, SolidSectionsFollowFromTheMaterial) {
  const RodSection solid = solid_round_section({2.0, 3.0, 5.0}, 0.1);
  EXPECT_DOUBLE_EQ(solid.stretching_stiffness, 2.0 * M_PI * 0.01);
  EXPECT_DOUBLE_EQ(solid.bending_stiffness, 2.0 * M_PI * 1e-4 / 4.0);
  EXPECT_DOUBLE_EQ(solid.twisting_stiffness, 3.0 * M_PI * 1e-4 / 2.0);
  EXPECT_DOUBLE_EQ(solid.mass_per_length, 5.0 * M_PI * 0.01);
  EXPECT_DOUBLE_EQ(solid.inertia_per_length, 5.0 * M_PI * 1e-4 / 2.0);
  const std::string rule = ", it must be positive and finite";
  expect_error(
      [] {
        solid_round_section({-1.0, 1.0, 1.0}, 0.1);
      },
      "youngs_modulus is -1.000000" + rule);
  expect_error(
      [] {
        solid_round_section({1.0, 0.0, 1.0}, 0.1);
      },
      "shear_modulus is 0.000000" + rule);
  expect_error([] { solid_round_section({1.0, 1.0, infinity}, 0.1); }, "density is inf" + rule);
  expect_error([] { solid_round_section({1.0, 1.0, 1.0}, nan); }, "radius is nan" + rule);
}

TEST(Effects, RefuseBadParameters) {
  expect_error(
      [] {
        Gravity({0, 0, infinity});
      },
      "gravity: the acceleration is (0.000000, 0.000000, inf) m/s^2, it must be finite");
  for (const double bad : {-1.0, infinity, nan}) {
    const std::string value = std::to_string(bad);
    expect_error([&] { Damping{bad}; }, "damping: the relaxation time is " + value +
                                            " s, it must be at least 0 and finite");
    struct Case {
      double Drag::Options::*option;
      const char* name;
    };
    for (const Case& each :
         {Case{&Drag::Options::fluid_density, "fluid_density"},
          Case{&Drag::Options::across, "across"}, Case{&Drag::Options::along, "along"}}) {
      Drag::Options options;
      options.*each.option = bad;
      expect_error([&] { Drag{options}; }, std::string("drag: ") + each.name + " is " + value +
                                               ", it must be at least 0 and finite");
    }
    Drag::Options period;
    period.wind.gust_period = bad;
    expect_error([&] { Drag{period}; },
                 "drag: gust_period is " + value + ", it must be positive and finite");
    Drag::Options length;
    length.wind.gust_length = bad;
    expect_error([&] { Drag{length}; },
                 "drag: gust_length is " + value + ", it must be positive and finite");
  }
  Drag::Options wind;
  wind.wind.gust.y() = nan;
  expect_error([&] { Drag{wind}; }, "drag: the wind must be finite");
}

TEST(Effects, TwistRefusesRodsThatDoNotResistIt) {
  const std::string problem = " needs a twisting stiffness and an inertia per length above 0";
  for (double RodSection::*value :
       {&RodSection::twisting_stiffness, &RodSection::inertia_per_length}) {
    RodSection changed = rod_section;
    changed.*value = 0.0;
    Rods rods;
    rods.add(points, 0.01, rod_section);
    rods.add(points, 0.01, changed);
    expect_error([&] { Twist{rods}; }, "twist: rod 1" + problem);
    EXPECT_TRUE(rods.angles.empty()) << "the rods are as they were";
  }
}

class AttachmentTest : public testing::Test {
 protected:
  void SetUp() override { rods_.add(points, 0.01, rod_section); }

  std::string error(const Attachment::Hold& hold) {
    return error_of([&] { attachment_.add(rods_, hold); });
  }

  Rods rods_;
  Attachment attachment_;
  Placement good_{Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()};
};

TEST_F(AttachmentTest, RefusesBadHolds) {
  Attachment::Hold other_rod = pin(2, Vector3d::Zero());
  other_rod.rod = 3;
  EXPECT_EQ(error(other_rod), "attachment: hold on node 2 of rod 3: there are 1 rods");
  EXPECT_EQ(error(pin(5, Vector3d::Zero())),
            "attachment: hold on node 5 of rod 0: the rod has 5 nodes");
  EXPECT_EQ(error({0, 1, Attachment::Kind::PIN, nullptr}),
            "attachment: hold on node 1 of rod 0: it has no placement");
  EXPECT_EQ(error(pin(1, {0, nan, 0})),
            "attachment: hold on node 1 of rod 0: its position must be finite");
  for (const double bad : {-1.0, infinity, nan}) {
    Attachment::Hold hold = pin(1, Vector3d::Zero());
    hold.max_force = bad;
    EXPECT_EQ(error(hold), "attachment: hold on node 1 of rod 0: its greatest force is " +
                               std::to_string(bad) + " N, it must be at least 0 and finite");
  }
  EXPECT_EQ(error(clamp(1, good_)),
            "attachment: hold on node 1 of rod 0: a clamp must be at an end of the rod");
  good_.tangent *= 1.1;
  EXPECT_EQ(error(clamp(0, good_)),
            "attachment: hold on node 0 of rod 0: a clamp's tangent must be of unit length");
}

TEST_F(AttachmentTest, RefusesBadDirectorsOfTwistedRods) {
  const std::string message =
      "attachment: hold on node 4 of rod 0: a clamp's director must be of unit length and across "
      "its tangent";
  const Twist twist(rods_);
  for (const Vector3d& bad : {Vector3d(0, 2, 0), Vector3d(0.6, 0.8, 0), Vector3d(0, 0, 0)}) {
    good_.director = bad;
    EXPECT_EQ(error(clamp(4, good_)), message);
  }
}

TEST_F(AttachmentTest, RefusesToHoldANodeTwiceAndToRemoveWhatIsNotThere) {
  const std::uint32_t id = attachment_.add(rods_, pin(4, Vector3d::Zero()));
  EXPECT_EQ(error(clamp(4, good_)), "attachment: hold on node 4 of rod 0: it is held already");
  EXPECT_EQ(error_of([&] { attachment_.remove(id + 1); }),
            "attachment: there is no hold " + std::to_string(id + 1));
  attachment_.remove(id);
  EXPECT_EQ(error_of([&] { attachment_.remove(id); }),
            "attachment: there is no hold " + std::to_string(id));
  EXPECT_EQ(error(clamp(4, good_)), "no error");
}

TEST_F(AttachmentTest, RefusesAPlacementThatGoesAstrayLater) {
  const auto path = [](double time) {
    return Placement{{time > 0.05 ? nan : 0.0, 0, 0}, Vector3d::Zero(), Vector3d::Zero()};
  };
  Stepper stepper(rods_, effects(hold(rods_, {{0, 0, Attachment::Kind::PIN, path}})), {});
  stepper.step(0.04);
  const std::vector<Vector3d> before = stepper.rods().positions;
  EXPECT_EQ(error_of([&] { stepper.step(0.04); }),
            "attachment: hold on node 0 of rod 0: its position must be finite");
  EXPECT_EQ(stepper.rods().positions, before);
  EXPECT_EQ(stepper.time(), 0.04);
}

TEST(StepperOptions, AreChecked) {
  StepperOptions options;
  options.max_iterations = 0;
  expect_error([&] { Stepper({}, {}, options); }, "max_iterations is 0, it must be at least 1");
  for (const double bad : {0.0, -1.0, infinity, nan}) {
    options = {};
    options.residual = bad;
    expect_error([&] { Stepper({}, {}, options); },
                 "residual is " + std::to_string(bad) + " m/s, it must be positive and finite");
  }
  Stepper stepper({}, {});
  for (const double bad : {0.0, -1.0, infinity, nan}) {
    expect_error([&] { stepper.step(bad); }, "the length of a step is " + std::to_string(bad) +
                                                 " s, it must be positive and finite");
  }
}

}  // namespace
}  // namespace fiber::test
