// When a skin is looked for, and what that may cost: in a small scene a choice takes as long as
// some searches do.

#include "src/query/skin_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "src/hierarchy/motion_bound.hpp"
#include "test/support/assemblies.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Frames of fibres of which every second one comes, and the others go, as an engine takes them.
class Frames {
 public:
  Frames() : fibers_(fibers()) { choice_.start(); }

  /// @param step     [m] by which points move
  /// @param estimate of the search
  void next(double step, const SkinChoice::Estimate& estimate) {
    std::vector<Vector3d> points = fibers_.points();
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].x() += i / 2 % 2 == 0 ? step : -step;
    }
    fibers_.update_points(points);
    choice_.end_frame();
    const bool has_motion = choice_.asks_for_motion();
    if (has_motion && motion_.measure(fibers_, choice_.skin(), 0.0).leaves(choice_.skin(), 0.0) &&
        !choice_.is_over()) {
      choice_.go_on();
      return;
    }
    choice_.begin_stretch(fibers_, has_motion ? &motion_ : nullptr);
    if (choice_.asks_for_motion()) {
      motion_.start(fibers_, Vector3d::Constant(-10.0), Vector3d::Constant(10.0));
    }
    choice_.decide(fibers_, [&](double skin, double max_pairs) {
      ++estimates_;
      return estimate(skin, max_pairs);
    });
  }

  const SkinChoice& choice() const { return choice_; }
  int estimates() const { return estimates_; }

 private:
  static FiberAssembly fibers() {
    AssemblyBuilder builder;
    for (int i = 0; i < 100; ++i) {
      builder.add_fiber({Vector3d(0.0, 0.01 * i, 0.0), Vector3d(0.0, 0.01 * i, 0.1)});
    }
    return builder.build({0.001});
  }

  FiberAssembly fibers_;
  MotionBound motion_;
  SkinChoice choice_{std::nullopt};
  int estimates_ = 0;
};

/// The search of a dense scene: a skin of a millimetre has a hundred times as many pairs as none.
SearchSize dense(double skin, double /*max_pairs*/) { return {1000.0, 100.0 + 1e7 * skin, 1.0}; }

TEST(SkinChoiceTest, NoneIsLookedForWhilePointsMoveAsFastAsWhereNonePaid) {
  Frames frames;
  for (int i = 0; i < 200; ++i) {
    frames.next(0.005, dense);
    ASSERT_EQ(frames.choice().skin(), 0.0);
  }
  EXPECT_GE(frames.estimates(), 1);
  EXPECT_LE(frames.estimates(), 5) << "one choice";
}

TEST(SkinChoiceTest, OneIsTakenSoonAfterPointsHaveBecomeSlow) {
  Frames frames;
  for (int i = 0; i < 20; ++i) {
    frames.next(0.005, dense);
  }
  EXPECT_EQ(frames.choice().skin(), 0.0);
  for (int i = 0; i < 40; ++i) {
    frames.next(1e-7, dense);
  }
  EXPECT_GT(frames.choice().skin(), 1e-7);
}

/// What the scene is may have changed, too.
TEST(SkinChoiceTest, OneIsTakenInTheEndWherePairsHaveBecomeFew) {
  Frames frames;
  for (int i = 0; i < 20; ++i) {
    frames.next(1e-4, dense);
  }
  EXPECT_EQ(frames.choice().skin(), 0.0);
  int with_a_skin = 0;
  for (int i = 0; i < 800; ++i) {
    frames.next(1e-4, [](double /*skin*/, double /*max_pairs*/) {
      return SearchSize{1000.0, 100.0, 1.0};
    });
    with_a_skin += frames.choice().skin() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(with_a_skin, 200);
}

/// More pairs than are asked for cost more than no skin does, whatever the number of boxes.
TEST(SkinChoiceTest, EstimatesMayEndWhereSoManyPairsCannotPay) {
  for (const double share : {0.9, 1.0001}) {
    Frames frames;
    int asked = 0;
    for (int i = 0; i < 10; ++i) {
      frames.next(1e-3, [&](double skin, double max_pairs) {
        if (skin == 0.0) {
          return SearchSize{1000.0, 100.0, 0.1};
        }
        ++asked;
        EXPECT_TRUE(std::isfinite(max_pairs));
        EXPECT_GT(max_pairs, 0.0);
        return SearchSize{0.0, share * max_pairs, 0.1};
      });
    }
    EXPECT_GT(asked, 0);
    EXPECT_EQ(frames.choice().skin() > 0.0, share < 1.0);
  }
}

}  // namespace
}  // namespace fiber::test
