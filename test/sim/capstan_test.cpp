// A rope that is drawn around a post, against Euler and Eytelwein: its tension grows with the angle
// as e^(mu theta).

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <utility>
#include <vector>

#include "test/support/random.hpp"
#include "validation/sim/friction_scenes.hpp"

namespace fiber::test {
namespace {

struct Drawn {
  const char* material;
  int degrees;
  double friction;

  double turns() const { return degrees / 360.0; }
  double exact() const { return std::exp(friction * 2.0 * M_PI * turns()); }
};

std::ostream& operator<<(std::ostream& out, const Drawn& drawn) {
  return out << drawn.material << ' ' << drawn.degrees << " degrees, coefficient "
             << drawn.friction;
}

class CapstanOf : public testing::TestWithParam<Drawn> {};

TEST_P(CapstanOf, HasItsRatioTo1PercentWith72EdgesATurn) {
  const Drawn& drawn = GetParam();
  const double found = tension_ratio({drawn.turns(), 72, drawn.material}, drawn.friction);
  EXPECT_NEAR(found, drawn.exact(), 0.01 * drawn.exact());
}

std::vector<Drawn> all_ropes() {
  std::vector<Drawn> all;
  for (const char* material : {"rope", "silicone_tube", "power_cable", "hair"}) {
    for (const int degrees : {90, 180, 360}) {
      for (const double friction : {0.1, 0.3, 0.6}) {
        all.push_back({material, degrees, friction});
      }
    }
  }
  return all;
}

/// A drum that turns under a belt slips as a belt that is drawn over it does.
TEST(Capstan, ADrumSlipsUnderABelt) {
  for (const auto& [degrees, friction] :
       {std::pair(90, 0.3), std::pair(180, 0.3), std::pair(180, 0.6)}) {
    const Drawn drawn{"rope", degrees, friction};
    const double found = tension_ratio_on_drum({drawn.turns(), 72}, friction);
    EXPECT_NEAR(found, drawn.exact(), 0.02 * drawn.exact()) << drawn;
  }
}

TEST(Capstan, ABeltSlipsOnTheSmallDrumAndGripsTheLargeOne) {
  for (const double friction : {0.2, 0.4}) {
    for (const bool turns_large : {true, false}) {
      SCOPED_TRACE(std::to_string(friction) + (turns_large ? ", large" : ", small") + " one turns");
      const BeltDrive found = simulated_belt_drive(turns_large, friction);
      const BeltDrive exact = exact_belt_drive(turns_large, friction);
      EXPECT_NEAR(found.tension_ratio, exact.tension_ratio, 0.02 * exact.tension_ratio);
      EXPECT_NEAR(found.speed, exact.speed, 0.002);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ropes, CapstanOf, testing::ValuesIn(all_ropes()));

/// Where the middle of an edge is nearer to the post than its ends by about the barrier's width,
/// the weight of the edge's contact is steepest: without all its second derivatives, of all three
/// distances together, no step of these ended in balance.
TEST(Capstan, BalancesHoweverLongTheEdgesAre) {
  const Drawn drawn{"rope", 360, 0.3};
  for (const int edges : {36, 42, 45, 48, 51, 54, 60}) {
    SCOPED_TRACE(edges);
    EXPECT_NEAR(tension_ratio({drawn.turns(), edges}, drawn.friction), drawn.exact(),
                0.012 * drawn.exact());
  }
}

/// Half the edges' length, a quarter of the error.
TEST(Capstan, ErrsInTheSecondOrderOfTheEdges) {
  const Drawn drawn{"rope", 360, 0.3};
  const auto error = [&](int edges) {
    return tension_ratio({drawn.turns(), edges}, drawn.friction) / drawn.exact() - 1.0;
  };
  const double coarse = error(24);
  const double fine = error(48);
  EXPECT_LT(std::abs(fine), 0.01);
  EXPECT_GT(std::abs(coarse / fine), 3.0);
}

}  // namespace
}  // namespace fiber::test
