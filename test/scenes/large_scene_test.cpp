#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "src/scenes/portable_math.hpp"
#include "test/support/error_of.hpp"
#include "test/support/hash.hpp"

namespace fiber {
namespace {

/// Segments that make several tufts of hair, the last one not whole.
std::uint64_t some_segments(const std::string& name) {
  return name == "tress_b" ? 1'030'000 : 40'000;
}

FiberAssembly whole(const LargeScene& scene, std::uint32_t frame = 0) {
  return scene.fibers(0, scene.fiber_count, frame);
}

TEST(LargeScene, IsTheSameInAnyParts) {
  for (const std::string& name : large_scene_names()) {
    const LargeScene scene = make_large_scene(name, some_segments(name), 3);
    const FiberAssembly expected = whole(scene, 7);
    EXPECT_EQ(expected.fiber_count(), scene.fiber_count);
    EXPECT_EQ(expected.segment_count(), scene.segment_count());
    for (const std::uint64_t parts : {1U, 2U, 3U, 7U}) {
      SCOPED_TRACE(name + " in " + std::to_string(parts) + " parts");
      std::vector<Eigen::Vector3d> points;
      for (std::uint64_t part = 0; part < parts; ++part) {
        const FiberAssembly some = make_large_scene(name, some_segments(name), 3)
                                       .fibers(scene.fiber_count * part / parts,
                                               scene.fiber_count * (part + 1) / parts, 7);
        points.insert(points.end(), some.points().begin(), some.points().end());
      }
      EXPECT_TRUE(points == expected.points());
    }
  }
}

TEST(LargeScene, HasTheSegmentsAskedForInWholeFibres) {
  struct Fibres {
    std::string name;
    std::uint32_t per_fiber;
    std::uint64_t typical;
  };
  for (const auto& [name, per_fiber, typical] :
       {Fibres{"soup", 100, 800}, Fibres{"tress_b", 2000, 144'000'000},
        Fibres{"locks", 64, 1'843'200}}) {
    SCOPED_TRACE(name);
    for (const std::uint64_t segments :
         {std::uint64_t{1}, std::uint64_t{per_fiber}, std::uint64_t{per_fiber + 1},
          std::uint64_t{10'000'000'000}, LargeScene::max_segments}) {
      const LargeScene scene = make_large_scene(name, segments);
      EXPECT_EQ(scene.segments_per_fiber, per_fiber);
      EXPECT_EQ(scene.typical_segments, typical);
      EXPECT_GE(scene.segment_count(), segments);
      EXPECT_LT(scene.segment_count(), segments + per_fiber);
    }
  }
}

/// How each fibre goes from its start to its end [nm], wherever that is.
std::set<std::vector<long>> ways_of(const FiberAssembly& fibers) {
  std::set<std::vector<long>> ways;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const Eigen::Vector3d way = 1e9 * (fibers.points()[fibers.offsets()[fiber + 1] - 1] -
                                       fibers.points()[fibers.offsets()[fiber]]);
    ways.insert({std::lround(way.x()), std::lround(way.y()), std::lround(way.z())});
  }
  return ways;
}

TEST(LargeScene, FibresDiffer) {
  for (const std::string& name : large_scene_names()) {
    SCOPED_TRACE(name);
    const LargeScene scene = make_large_scene(name, some_segments(name), 3);
    std::set<std::vector<long>> ways = ways_of(whole(scene));
    EXPECT_EQ(ways.size(), scene.fiber_count);
    ways.merge(ways_of(whole(make_large_scene(name, some_segments(name), 4))));
    EXPECT_EQ(ways.size(), 2 * scene.fiber_count) << "another seed";
    EXPECT_FALSE(whole(scene, 1).points() == whole(scene, 0).points()) << "frames";
    EXPECT_TRUE(whole(scene, 100).points() == whole(scene, 0).points()) << "the sway repeats";
  }
}

double contacts_per_segment(const LargeScene& scene) {
  const FiberAssembly fibers = whole(scene);
  const auto engine = make_engine("run_tree");
  engine->update(fibers);
  QueryOptions options;
  options.neighbour_skip = 1;
  QueryResult result;
  engine->query(options, result);
  return static_cast<double>(result.contacts.size()) / static_cast<double>(fibers.segment_count());
}

TEST(LargeScene, StaysAsDenseWhenItGrows) {
  // A smaller scene has more of what is at the sides.
  struct Sizes {
    std::string name;
    std::uint64_t small, large;
  };
  for (const Sizes& sizes :
       {Sizes{"soup", 400'000, 3'200'000}, Sizes{"tress_b", 1'000'000, 3'000'000},
        Sizes{"locks", 400'000, 1'600'000}}) {
    SCOPED_TRACE(sizes.name);
    const double small = contacts_per_segment(make_large_scene(sizes.name, sizes.small));
    const double large = contacts_per_segment(make_large_scene(sizes.name, sizes.large));
    EXPECT_NEAR(large / small, 1.0, 0.1);
  }
}

TEST(LargeScene, SaysWhatIsWrong) {
  const auto refusal = [](const std::string& name, std::uint64_t segments) {
    return test::error_of([&] { make_large_scene(name, segments); });
  };
  EXPECT_EQ(refusal("cloth", 100), "unknown scene 'cloth', known are: soup, tress_b, locks");
  EXPECT_EQ(refusal("soup", 0), "segments is 0, it must be from 1 to 1000000000000000");
  EXPECT_EQ(refusal("soup", LargeScene::max_segments + 1),
            "segments is 1000000000000001, it must be from 1 to 1000000000000000");
  const LargeScene scene = make_large_scene("soup", LargeScene::max_segments);
  EXPECT_EQ(test::error_of([&] { scene.fibers(3, 2, 0); }),
            "fibres from 3 to before 2, there are 10000000000000");
  EXPECT_EQ(test::error_of([&] { scene.fibers(9'999'999'999'999, 10'000'000'000'001, 0); }),
            "fibres from 9999999999999 to before 10000000000001, there are 10000000000000");
  EXPECT_EQ(test::error_of([&] { scene.fibers(0, 21'262'215, 0); }),
            "21262215 fibres in one part, there may be at most 21262214: make more parts");
  const FiberAssembly last = scene.fibers(9'999'999'999'999, 10'000'000'000'000, 0);
  EXPECT_EQ(last.fiber_count(), 1U);
  EXPECT_EQ(scene.fibers(5, 5, 0).fiber_count(), 0U);
}

TEST(LargeScene, IsTheSameBitsOnEveryMachine) {
  std::vector<std::uint64_t> actual;
  for (const std::string& name : large_scene_names()) {
    actual.push_back(test::hash(make_large_scene(name, 1'000'000'000, 2).fibers(7, 12, 3)));
  }
  EXPECT_EQ(actual, (std::vector<std::uint64_t>{14655343136600437767U, 10245340850988248897U,
                                                17176142881671320089U}));
}

TEST(PortableMath, CubeRootIsThatOfLibm) {
  for (double x = 1e-18; x < 1e18; x *= 3.7) {
    ASSERT_NEAR(cube_root(x) / std::cbrt(x), 1.0, 1e-15) << x;
  }
}

}  // namespace
}  // namespace fiber
