#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "src/rviz/fiber_detail.hpp"
#include "test/support/assemblies.hpp"

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;
using fiber::test::Random;

/// Tens of thousands of segments, of short and long fibres with radii of their own.
FiberAssembly many_fibers(Random& random) {
  fiber::test::AssemblyBuilder builder;
  std::vector<double> radii;
  for (const int segments : {1, 2, 255, 256, 257, 1000, 20000}) {
    for (int left = 60000 / 7; left > 0; left -= std::max(segments, 50)) {
      builder.add_fiber(fiber::test::random_walk(random, segments, 0.01));
      radii.push_back(random.uniform(0.0, 0.1));
    }
  }
  return builder.build(radii);
}

TEST(FiberChunks, HoldEverySegmentOnceAndEncloseIt) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  const FiberAssembly fibers = many_fibers(random);
  const Vector3d origin(0.1, 0.2, 0.3);
  const std::vector<FiberChunk> chunks = make_chunks(fibers, origin);
  EXPECT_GE(chunks.size(), fibers.segment_count() / max_chunk_segments);
  std::vector<int> held(fibers.point_count(), 0);
  for (const FiberChunk& chunk : chunks) {
    std::size_t count = 0;
    for (const PointRange& range : chunk.ranges) {
      ASSERT_LT(range.first, range.last);
      for (std::uint32_t point = range.first; point < range.last; ++point) {
        ++held[point];
        ++count;
        const double radius = fibers.segment_radius(point);
        ASSERT_LE(radius, chunk.largest_radius);
        Eigen::AlignedBox3d box = chunk.box.cast<double>();
        box.min().array() -= 1e-5;  // single precision
        box.max().array() += 1e-5;
        for (const std::uint32_t end : {point, point + 1}) {
          const Vector3d place = fibers.points()[end] - origin;
          ASSERT_TRUE(box.contains(Vector3d(place.array() - radius)));
          ASSERT_TRUE(box.contains(Vector3d(place.array() + radius)));
        }
      }
    }
    EXPECT_EQ(count, chunk.segment_count);
    EXPECT_LE(count, max_chunk_segments);
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t p = fibers.offsets()[fiber]; p < fibers.offsets()[fiber + 1]; ++p) {
      ASSERT_EQ(held[p], p + 1 < fibers.offsets()[fiber + 1] ? 1 : 0) << p;
    }
  }
}

TEST(FiberChunks, LieApart) {
  // Fibres in two heaps, in turns: no chunk is of both.
  fiber::test::AssemblyBuilder builder;
  for (int fiber = 0; fiber < 400; ++fiber) {
    std::vector<Vector3d> points;
    for (int i = 0; i <= 100; ++i) {
      points.emplace_back(100.0 * (fiber % 2), 0.001 * fiber, 0.01 * i);
    }
    builder.add_fiber(points);
  }
  const std::vector<FiberChunk> chunks = make_chunks(builder.build({0.001}), Vector3d::Zero());
  EXPECT_EQ(chunks.size(), 4U);
  for (const FiberChunk& chunk : chunks) {
    EXPECT_LT(chunk.box.sizes().x(), 1.0F);
  }
}

TEST(FiberChunks, AreTheSameForAnyNumberOfThreads) {
  SCOPED_TRACE(fiber::test::seed_message());
  Random random;
  const FiberAssembly fibers = many_fibers(random);
  const std::vector<FiberChunk> some = make_chunks(fibers, Vector3d::Zero());
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<FiberChunk> again = make_chunks(fibers, Vector3d::Zero());
  ASSERT_EQ(some.size(), again.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].box.min(), again[i].box.min());
    EXPECT_EQ(some[i].box.max(), again[i].box.max());
    ASSERT_EQ(some[i].ranges.size(), again[i].ranges.size());
    for (std::size_t k = 0; k < some[i].ranges.size(); ++k) {
      ASSERT_EQ(some[i].ranges[k].first, again[i].ranges[k].first);
    }
  }
}

TEST(FiberChunks, NothingGivesNone) {
  EXPECT_TRUE(make_chunks(FiberAssembly(), Vector3d::Zero()).empty());
}

}  // namespace
}  // namespace fiber_proximity_rviz
