#include "src/ros/inputs/missing_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "test/support/not_finite.hpp"

namespace fiber_proximity_ros {
namespace {

using Names = std::vector<std::string>;
using Offsets = std::vector<std::uint32_t>;
using Radii = std::vector<double>;

using fiber::test::infinity;
using fiber::test::nan;

/// Fibres as strings: a point per character, `.` known and `x` missing. The x of a point tells its
/// place among all.
FiberBuffer buffer_of(const std::vector<std::string>& fibers) {
  FiberBuffer buffer;
  buffer.header.frame_id = "camera";
  const std::vector<Eigen::Vector3d> missing{{nan, 0, 0}, {0, infinity, 0}, {0, 0, -infinity}};
  for (const std::string& fiber : fibers) {
    for (const char point : fiber) {
      const auto place = static_cast<double>(buffer.points.size());
      buffer.points.emplace_back(place, 0, 0);
      if (point == 'x') {
        buffer.points.back() = missing[buffer.points.size() % missing.size()];
      }
    }
    buffer.end_chain();
    buffer.names.push_back("f" + std::to_string(buffer.names.size()));
  }
  return buffer;
}

/// Fibres as lists of the places their points had.
std::vector<std::vector<int>> places(const FiberBuffer& buffer) {
  std::vector<std::vector<int>> fibers(buffer.fiber_count());
  for (std::size_t fiber = 0; fiber < fibers.size(); ++fiber) {
    for (std::uint32_t i = buffer.offsets[fiber]; i < buffer.offsets[fiber + 1]; ++i) {
      fibers[fiber].push_back(static_cast<int>(buffer.points[i].x()));
    }
  }
  return fibers;
}

using Places = std::vector<std::vector<int>>;

struct Handled {
  FiberBuffer buffer;
  MissingPointCounts counts;
};

Handled handle(MissingPoints policy, const FiberBuffer& buffer) {
  Handled handled{buffer, {}};
  resolve_missing_points(policy, handled.buffer, handled.counts);
  EXPECT_EQ(handled.buffer.header.frame_id, "camera");
  EXPECT_EQ(handled.buffer.names.size(), handled.buffer.fiber_count());
  return handled;
}

void expect_counts(const MissingPointCounts& counts, std::uint64_t points, std::uint64_t gaps,
                   std::uint64_t fibers, std::uint64_t lone_points) {
  EXPECT_EQ(counts.points, points);
  EXPECT_EQ(counts.gaps, gaps);
  EXPECT_EQ(counts.fibers, fibers);
  EXPECT_EQ(counts.lone_points, lone_points);
}

TEST(MissingPoints, ABridgeJoinsTheNeighboursAndDropsTheEnds) {
  const Handled handled = handle(MissingPoints::BRIDGE, buffer_of({"x.x..xx.xx", "...", ".x."}));
  EXPECT_EQ(places(handled.buffer), (Places{{1, 3, 4, 7}, {10, 11, 12}, {13, 15}}));
  EXPECT_EQ(handled.buffer.names, (Names{"f0", "f1", "f2"}));
  expect_counts(handled.counts, 7, 3, 0, 0);
}

TEST(MissingPoints, ASplitKeepsThePiecesAndNamesThemByTheirFirstPoint) {
  const Handled handled = handle(MissingPoints::SPLIT, buffer_of({"x..x.x...x..", "...", "..x.."}));
  EXPECT_EQ(places(handled.buffer),
            (Places{{1, 2}, {6, 7, 8}, {10, 11}, {12, 13, 14}, {15, 16}, {18, 19}}));
  EXPECT_EQ(handled.buffer.names, (Names{"f0", "f0[6]", "f0[10]", "f1", "f2", "f2[3]"}));
  expect_counts(handled.counts, 5, 5, 0, 1);
}

TEST(MissingPoints, AFibreOfWhichTooLittleIsKnownIsAbsent) {
  for (const MissingPoints policy : {MissingPoints::BRIDGE, MissingPoints::SPLIT}) {
    const Handled handled = handle(policy, buffer_of({"xxx", "...", "x.x", "xx"}));
    EXPECT_EQ(places(handled.buffer), (Places{{3, 4, 5}}));
    EXPECT_EQ(handled.buffer.names, (Names{"f1"}));
    expect_counts(handled.counts, 7, 7, 3, 1);
  }
  const Handled split = handle(MissingPoints::SPLIT, buffer_of({".x.x."}));
  EXPECT_EQ(places(split.buffer), Places{});
  expect_counts(split.counts, 2, 2, 1, 3);
}

TEST(MissingPoints, NothingLeftIsAnAssemblyOfNoFibres) {
  for (const Radii& radii : {Radii{}, Radii{0.5}, Radii{0.5, 0.25}, Radii{1, 2, 3, 4, 5}}) {
    FiberBuffer buffer = buffer_of({"xxx", "xx"});
    buffer.radii = radii;
    FiberBuffer left = handle(MissingPoints::SPLIT, buffer).buffer;
    EXPECT_EQ(left.fiber_count(), 0U);
    left.radii.resize(1);  // as the input does
    fiber::FiberAssembly fibers;
    EXPECT_NO_THROW(assign(left, fibers));
    EXPECT_EQ(fibers.fiber_count(), 0U);
  }
}

TEST(MissingPoints, RadiiGoWithTheirPointsOrFibres) {
  FiberBuffer buffer = buffer_of({"..x..", ".x.", "xx"});
  const auto radii_after = [&buffer](MissingPoints policy, const Radii& radii) {
    buffer.radii = radii;
    FiberBuffer left = handle(policy, buffer).buffer;
    Radii radii_left = left.radii;
    fiber::FiberAssembly fibers;
    EXPECT_NO_THROW(assign(left, fibers));
    return radii_left;
  };
  EXPECT_EQ(radii_after(MissingPoints::SPLIT, {7}), Radii{7});
  EXPECT_EQ(radii_after(MissingPoints::SPLIT, {1, 2, 3}), (Radii{1, 1}));
  EXPECT_EQ(radii_after(MissingPoints::BRIDGE, {1, 2, 3}), (Radii{1, 2}));
  // The radius of a missing point may be missing, too.
  const Radii per_point{1, 2, nan, 4, 5, 6, nan, 8, nan, nan};
  EXPECT_EQ(radii_after(MissingPoints::SPLIT, per_point), (Radii{1, 2, 4, 5}));
  EXPECT_EQ(radii_after(MissingPoints::BRIDGE, per_point), (Radii{1, 2, 4, 5, 6, 8}));
}

TEST(MissingPoints, NamesStayUniqueWhateverTheTrackerCallsItsFibres) {
  FiberBuffer buffer = buffer_of({"..x..x..", "..", "..x.."});
  buffer.names = {"f", "f[3]", "f[3][3]"};
  const Names names = handle(MissingPoints::SPLIT, buffer).buffer.names;
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 6U);
  EXPECT_EQ(names[0], "f");
  EXPECT_EQ(names[2], "f[6]");
  EXPECT_EQ(names[3], "f[3]");
  EXPECT_EQ(names[4], "f[3][3]");
}

TEST(MissingPoints, ThePieceOfTheSamePointsHasTheSameNameWhateverElseIsMissing) {
  EXPECT_EQ(handle(MissingPoints::SPLIT, buffer_of({"..x...x..x.."})).buffer.names[2], "f0[7]");
  EXPECT_EQ(handle(MissingPoints::SPLIT, buffer_of({"......x..x.."})).buffer.names[1], "f0[7]");
  EXPECT_EQ(handle(MissingPoints::SPLIT, buffer_of({".x.x..x..xxx"})).buffer.names[1], "f0[7]");
}

TEST(MissingPoints, RefusedIsTheFirstByNameAndAllAreCounted) {
  FiberBuffer buffer = buffer_of({"...", "..x.x"});
  MissingPointCounts counts;
  try {
    resolve_missing_points(MissingPoints::REFUSE, buffer, counts);
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("fibre 1, point 2: x is nan, coordinates must be ", 0), 0U) << message;
    EXPECT_NE(message.find("missing_points: bridge or split"), std::string::npos) << message;
  }
  expect_counts(counts, 2, 0, 0, 0);
}

TEST(MissingPoints, WhatLiesAboutItsLayoutStaysForTheAssemblyToRefuse) {
  const auto expect_untouched = [](const std::function<void(FiberBuffer&)>& spoil) {
    FiberBuffer buffer = buffer_of({"..x..", "..."});
    spoil(buffer);
    const Offsets offsets = buffer.offsets;
    MissingPointCounts counts;
    for (const MissingPoints policy : {MissingPoints::BRIDGE, MissingPoints::SPLIT}) {
      resolve_missing_points(policy, buffer, counts);
      EXPECT_EQ(buffer.points.size(), 8U);
      EXPECT_EQ(buffer.offsets, offsets);
      buffer.radii.resize(std::max<std::size_t>(buffer.radii.size(), 1));
      FiberBuffer assigned = buffer;
      fiber::FiberAssembly fibers;
      EXPECT_THROW(assign(assigned, fibers), std::invalid_argument);
    }
    expect_counts(counts, 0, 0, 0, 0);
  };
  expect_untouched([](FiberBuffer& buffer) { buffer.offsets.clear(); });
  expect_untouched([](FiberBuffer& buffer) { buffer.offsets = {0, 6, 5, 8}; });
  expect_untouched([](FiberBuffer& buffer) { buffer.offsets = {0, 5, 9}; });
  expect_untouched([](FiberBuffer& buffer) { buffer.offsets = {1, 5, 8}; });
  expect_untouched([](FiberBuffer& buffer) { buffer.offsets = {0, 5, 7}; });
  expect_untouched([](FiberBuffer& buffer) { buffer.offsets = {0, 5, 7, 8}; });
  expect_untouched([](FiberBuffer& buffer) { buffer.offsets = {0, 5, 0xFFFF'FFFFU, 8}; });
  // Two pieces and another fibre would have three radii.
  expect_untouched([](FiberBuffer& buffer) { buffer.radii = {1, 2, 3}; });
}

TEST(MissingPoints, OfRandomFibresEveryKnownPointIsInOrderOrCounted) {
  std::mt19937 random(8);
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::string> fibers(1 + random() % 4);
    for (std::string& fiber : fibers) {
      fiber.resize(2 + random() % 8);
      for (char& point : fiber) {
        point = random() % 3 == 0 ? 'x' : '.';
      }
    }
    const FiberBuffer buffer = buffer_of(fibers);
    for (const MissingPoints policy : {MissingPoints::BRIDGE, MissingPoints::SPLIT}) {
      const Handled handled = handle(policy, buffer);
      std::size_t known = 0;
      std::set<std::uint32_t> fibers_left;
      for (const std::vector<int>& piece : places(handled.buffer)) {
        ASSERT_GE(piece.size(), 2U);
        const auto fiber_of = [&buffer](int place) {
          return static_cast<std::uint32_t>(std::upper_bound(buffer.offsets.begin(),
                                                             buffer.offsets.end(),
                                                             static_cast<std::uint32_t>(place)) -
                                            buffer.offsets.begin());
        };
        fibers_left.insert(fiber_of(piece.front()));
        for (std::size_t i = 0; i + 1 < piece.size(); ++i) {
          ASSERT_EQ(fiber_of(piece[i]), fiber_of(piece[i + 1]));
          if (policy == MissingPoints::SPLIT) {
            ASSERT_EQ(piece[i] + 1, piece[i + 1]);
          }
          for (int between = piece[i] + 1; between < piece[i + 1]; ++between) {
            ASSERT_FALSE(buffer.points[static_cast<std::size_t>(between)].allFinite());
          }
        }
        known += piece.size();
      }
      EXPECT_EQ(known + handled.counts.lone_points + handled.counts.points, buffer.points.size());
      EXPECT_EQ(fibers_left.size() + handled.counts.fibers, fibers.size());
      const Names& names = handled.buffer.names;
      EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    }
  }
}

}  // namespace
}  // namespace fiber_proximity_ros
