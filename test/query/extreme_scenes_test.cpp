// Scenes at the ends of what an assembly may be: run_tree gives the contacts of brute force, or of
// one of the paper's hierarchies where a million segments are too many for that, to the bit.
#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/paper/paper_engines.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

class ExtremeScenesTest : public testing::Test {
 protected:
  void expect(const FiberAssembly& fibers, const std::vector<Contact>& contacts) {
    for (const auto& engine : {one_thread_.get(), two_threads_.get()}) {
      engine->update(fibers);
      EXPECT_TRUE(same_contacts(answer(*engine, options_).contacts, contacts))
          << engine->facts().thread_count << " threads";
    }
    found_ += contacts.size();
  }

  void expect_brute_forces(const FiberAssembly& fibers) {
    expect(fibers, brute_force(fibers, options_).contacts);
  }

  /// After a build, then after updates of moved points.
  void expect_brute_forces_in_motion(FiberAssembly fibers, double half_edge) {
    expect_brute_forces(fibers);
    for (int frame = 0; frame < 3; ++frame) {
      fibers.update_points(shaken(fibers, half_edge, random_).points());
      expect_brute_forces(fibers);
    }
  }

  void expect_same_as_in_motion(const std::string& name, FiberAssembly fibers, double half_edge) {
    register_paper_engines();
    const auto other = make_engine(name);
    for (int frame = 0; frame < 2; ++frame) {
      other->update(fibers);
      expect(fibers, answer(*other, options_).contacts);
      fibers.update_points(shaken(fibers, half_edge, random_).points());
    }
  }

  QueryOptions options_ = [] {
    QueryOptions options;
    options.neighbour_skip = 1;  // as many contacts as there can be
    return options;
  }();
  Random random_;
  std::unique_ptr<ProximityEngine> one_thread_ = make_engine("run_tree", {1});
  std::unique_ptr<ProximityEngine> two_threads_ = make_engine("run_tree", {2});
  std::size_t found_ = 0;  // contacts so far
};

TEST_F(ExtremeScenesTest, OneFiberOfAMillionSegments) {
  SCOPED_TRACE(seed_message());
  expect_same_as_in_motion("AL", walks(random_, 1, 1'000'000, 1.0, 0.3), 0.2);
  expect_enough(found_, std::size_t{1001});
}

TEST_F(ExtremeScenesTest, AMillionFibersOfOneSegment) {
  SCOPED_TRACE(seed_message());
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 1'000'000; ++fiber) {
    const Vector3d centre = random_.in_cube(100.0);
    const Vector3d half = 0.5 * random_.direction();
    builder.add_fiber({centre - half, centre + half});
  }
  expect_same_as_in_motion("AS", builder.build({0.02}), 0.2);
  expect_enough(found_, std::size_t{1001});
}

TEST_F(ExtremeScenesTest, RadiiBeyondTheScene) {
  SCOPED_TRACE(seed_message());
  expect_brute_forces_in_motion(walks(random_, 20, 20, 0.1, 100.0), 0.1);
  // Every pair but the neighbours along a fibre, in each of four frames.
  EXPECT_EQ(found_, 4U * (400U * 399U / 2U - 20U * 19U));
}

TEST_F(ExtremeScenesTest, RadiiFromZeroToBeyondTheScene) {
  SCOPED_TRACE(seed_message());
  AssemblyBuilder builder;
  std::vector<double> radii;
  for (int fiber = 0; fiber < 40; ++fiber) {
    builder.add_fiber(random_walk(random_, 15, 0.1));
    radii.push_back(fiber % 5 == 0 ? 0.0 : std::pow(10.0, random_.uniform(-12.0, 2.0)));
  }
  expect_brute_forces_in_motion(builder.build(radii), 0.1);
  expect_enough(found_, std::size_t{1001});
}

// Halves and powers of two, so that a crossing is exactly on both lines and nothing is rounded.
TEST_F(ExtremeScenesTest, RadiiOfZeroAndSegmentsThatCross) {
  constexpr int lines = 30;
  const auto line = [](const Vector3d& centre, const Vector3d& half) {
    return Points{centre - half, centre, centre + half};
  };
  AssemblyBuilder builder;
  for (int i = 0; i < lines; ++i) {
    builder.add_fiber(line(Vector3d(0.5, i, 0.0), Vector3d(64.0, 0.0, 0.0)));
    builder.add_fiber(line(Vector3d(i, 0.5, 0.0), Vector3d(0.0, 64.0, 0.0)));
  }
  FiberAssembly fibers = builder.build({0.0});
  constexpr std::size_t crossings = lines * lines;
  expect_brute_forces(fibers);
  EXPECT_EQ(found_, crossings);

  // Every other line aside: by next to nothing, then by the last bit of a coordinate far away.
  const Points crossing = fibers.points();
  const auto place = [&](const Vector3d& away, double aside) {
    Points points = crossing;
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] += away;
      points[i].z() += i / 3 % 2 == 0 ? 0.0 : aside;
    }
    fibers.update_points(points);
    found_ = 0;
    expect_brute_forces(fibers);
    return found_;
  };
  const Vector3d far(1e6, -1e6, 1e6);
  EXPECT_EQ(place(Vector3d::Zero(), 1e-150), 0U);
  EXPECT_EQ(place(Vector3d::Zero(), 0.0), crossings);
  EXPECT_EQ(place(far, 0x1p-33), 0U);
  EXPECT_EQ(place(far, 0.0), crossings);
}

TEST_F(ExtremeScenesTest, RadiiOfZeroAndStarsOfSegments) {
  SCOPED_TRACE(seed_message());
  const auto whole = [this](int most) {
    return Vector3d(random_.integer(-most, most), random_.integer(-most, most),
                    random_.integer(-most, most));
  };
  AssemblyBuilder builder;
  for (int star = 0; star < 60; ++star) {
    const Vector3d centre = whole(20);
    for (int ray = 0; ray < 6; ++ray) {
      const Vector3d half = whole(3);
      builder.add_fiber({centre - half, centre + half});
    }
  }
  expect_brute_forces(builder.build({0.0}));
  expect_enough(found_, std::size_t{61});
}

TEST_F(ExtremeScenesTest, IdenticalFibers) {
  SCOPED_TRACE(seed_message());
  for (const double radius : {0.0, 0.01}) {
    const Points fiber = random_walk(random_, 4, 0.1);
    FiberAssembly fibers = as_fibers(std::vector(200, fiber), radius);
    found_ = 0;
    expect_brute_forces(fibers);
    EXPECT_GE(found_, 4U * 200U * 199U / 2U);  // each segment with its copies

    Points moved;
    const Points elsewhere = random_walk(random_, 4, 0.1);
    for (std::size_t i = 0; i < fibers.point_count(); ++i) {
      moved.push_back(elsewhere[i % elsewhere.size()]);
    }
    fibers.update_points(moved);
    found_ = 0;
    expect_brute_forces(fibers);
    EXPECT_GE(found_, 4U * 200U * 199U / 2U);
  }
}

TEST_F(ExtremeScenesTest, AKilometreBesideMicrometres) {
  SCOPED_TRACE(seed_message());
  const Vector3d along = random_.direction();
  AssemblyBuilder builder;
  builder.add_fiber({-500.0 * along, 500.0 * along});
  for (int grain = 0; grain < 600; ++grain) {
    const double place = grain % 2 == 0 ? 0.0 : random_.uniform(-500.0, 500.0);
    const Vector3d start = place * along + random_.in_cube(3e-6);
    builder.add_fiber({start, start + 1e-6 * random_.direction()});
  }
  expect_brute_forces_in_motion(builder.build({5e-7}), 1e-6);
  expect_enough(found_, std::size_t{1001});
}

TEST_F(ExtremeScenesTest, AMillionMetresFromTheOrigin) {
  SCOPED_TRACE(seed_message());
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 40; ++fiber) {
    Points points = random_walk(random_, 15, 0.1);
    for (Vector3d& point : points) {
      point *= 1e-2;
    }
    builder.add_fiber(points);
  }
  FiberAssembly fibers = builder.build({3e-4});
  const Points near = fibers.points();
  // There and back: a hierarchy is relative to an origin that has to follow.
  for (const double away : {1e6, 0.0, 1e6}) {
    const Vector3d offset = away * random_.direction();
    Points points = near;
    for (Vector3d& point : points) {
      point += offset;
    }
    fibers.update_points(points);
    found_ = 0;
    expect_brute_forces_in_motion(fibers, 1e-3);
    SCOPED_TRACE(testing::Message() << away << " m away");
    expect_enough(found_, std::size_t{101});
  }
}

}  // namespace
}  // namespace fiber::test
