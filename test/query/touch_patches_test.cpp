// Touches over random steps, beside what is told by looking at all pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "test/query/touch_tracker_fixture.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using std::chrono::nanoseconds;

/// Whether two pairs hang together: their segments are the same or next to each other.
bool are_neighbours(const TouchingPair& x, const TouchingPair& y, const TouchSeams& seams) {
  const auto are_near = [&](std::uint32_t fiber, std::uint32_t i, std::uint32_t j,
                            bool may_be_closed) {
    const std::uint32_t apart = i < j ? j - i : i - j;
    const bool is_closed = may_be_closed && fiber < seams.last_segments.size();
    return apart <= 1 || (is_closed && apart > 0 && apart == seams.last_segments[fiber]);
  };
  const bool are_same_way = are_near(x.fiber_a, x.segment_a, y.segment_a, true) &&
                            are_near(x.fiber_b, x.segment_b, y.segment_b, seams.are_of_both);
  const bool are_other_way = seams.are_of_both && x.fiber_a == x.fiber_b &&
                             are_near(x.fiber_a, x.segment_a, y.segment_b, true) &&
                             are_near(x.fiber_a, x.segment_b, y.segment_a, true);
  return x.fiber_a == y.fiber_a && x.fiber_b == y.fiber_b && (are_same_way || are_other_way);
}

/// The first pair of the patch of each pair that is wanted, by looking at all pairs until nothing
/// changes any more.
template <class IsWanted>
std::vector<std::size_t> patches_of(const std::vector<TouchingPair>& pairs,
                                    const IsWanted& is_wanted, const TouchSeams& seams = {}) {
  std::vector<std::size_t> patch(pairs.size());
  for (std::size_t i = 0; i < patch.size(); ++i) {
    patch[i] = i;
  }
  for (bool changes = true; changes;) {
    changes = false;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (std::size_t j = 0; j < pairs.size(); ++j) {
        if (is_wanted(pairs[i]) && is_wanted(pairs[j]) && patch[j] < patch[i] &&
            are_neighbours(pairs[i], pairs[j], seams)) {
          patch[i] = patch[j];
          changes = true;
        }
      }
    }
  }
  return patch;
}

/// Against patches that are grown by looking at all pairs, over random steps; that every touch
/// begins once, ends once, and is there in between.
TEST_F(TouchTrackerTest, PatchesAreThoseOfAllPairs) {
  Random random;
  std::map<std::uint64_t, bool> open;
  std::size_t ended = 0;
  for (int round = 0; round < rounds(300); ++round) {
    // Of a few fibres: the last segment of one is no neighbour of the first of the next.
    std::set<std::array<std::uint32_t, 4>> drawn;
    const auto count = random.integer(0, 60);
    for (std::int64_t i = 0; i < count; ++i) {
      drawn.insert({static_cast<std::uint32_t>(random.integer(0, 1)),
                    static_cast<std::uint32_t>(random.integer(0, 11)),
                    static_cast<std::uint32_t>(random.integer(1, 2)),
                    static_cast<std::uint32_t>(random.integer(0, 11))});
    }
    std::vector<TouchingPair> pairs;
    for (const auto& [fiber_a, a, fiber_b, b] : drawn) {
      pairs.push_back({fiber_a, a, fiber_b, b, -1e-3, false, step_, {}});
    }
    for (const TouchEvent& event : step_with(pairs)) {
      if (event.kind == TouchEvent::Kind::BEGAN) {
        EXPECT_TRUE(open.emplace(event.touch.id, true).second);
      } else {
        EXPECT_EQ(open.erase(event.touch.id), 1U);
        ++ended;
      }
    }
    const std::vector<std::size_t> patch = patches_of(pairs, [](const auto&) { return true; });
    std::set<std::uint64_t> there;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      there.insert(ids_[i]);
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_EQ(ids_[i] == ids_[j], patch[i] == patch[j]);
      }
    }
    ASSERT_EQ(there.size(), open.size());
    for (const std::uint64_t id : there) {
      ASSERT_EQ(open.count(id), 1U);
    }
  }
  expect_enough(ended, static_cast<std::size_t>(rounds(500)));
}

/// A random walk of what touches: some pairs stay, some leave, some come, some come and go.
class TouchingWalk {
 public:
  explicit TouchingWalk(Random& random) : random_(random) {}

  std::vector<TouchingPair> next(const TimeBounds& step) {
    std::map<Key, TouchingPair> pairs;
    const auto time_from = [&](std::int64_t begin) {
      const std::int64_t time =
          begin + random_.integer(0, static_cast<int>(step.upper.count() - begin));
      return at(time, std::min<std::int64_t>(time + 3, step.upper.count()));
    };
    for (const Key& key : standing_) {
      const bool is_gone = random_.uniform(0, 1) < 0.3;
      TouchingPair pair = make(key, is_gone, {step.lower, step.lower});
      pair.last = is_gone ? time_from(step.lower.count()) : TimeBounds{};
      pairs.emplace(key, pair);
    }
    for (std::int64_t i = random_.integer(0, 25); i > 0; --i) {
      const Key key{0, static_cast<std::uint32_t>(random_.integer(0, 9)), 1,
                    static_cast<std::uint32_t>(random_.integer(0, 9))};
      const TimeBounds first = time_from(step.lower.count() + 1);
      TouchingPair pair = make(key, random_.uniform(0, 1) < 0.5, first);
      pair.last = pair.is_gone ? time_from(first.upper.count()) : TimeBounds{};
      pairs.emplace(key, pair);
    }
    std::vector<TouchingPair> sorted;
    standing_.clear();
    for (const auto& [key, pair] : pairs) {
      sorted.push_back(pair);
      if (!pair.is_gone) {
        standing_.insert(key);
      }
    }
    return sorted;
  }

  using Key = std::array<std::uint32_t, 4>;

 private:
  static TouchingPair make(const Key& key, bool is_gone, const TimeBounds& first) {
    return {key[0], key[1], key[2], key[3], -1e-3, is_gone, first, {}};
  }

  Random& random_;
  std::set<Key> standing_;
};

/// Beside what is told by looking at all pairs: a touch is what hangs together at the end of a
/// step.
TEST_F(TouchTrackerTest, TouchesAreWhatHangsTogetherAtTheEndOfAStep) {
  Random random;
  TouchingWalk walk(random);
  std::map<TouchingWalk::Key, std::uint64_t> before;
  std::set<std::uint64_t> open;
  std::size_t parted = 0;
  std::size_t stayed = 0;
  for (int round = 0; round < rounds(1000); ++round) {
    const TimeBounds step = step_;
    const std::vector<TouchingPair> pairs = walk.next(step);
    const std::vector<TouchEvent> events = step_with(pairs);
    const auto stands = [](const TouchingPair& pair) { return !pair.is_gone; };
    const std::vector<std::size_t> whole = patches_of(pairs, [](const auto&) { return true; });
    const std::vector<std::size_t> parts = patches_of(pairs, stands);
    std::map<TouchingWalk::Key, std::uint64_t> now;
    std::set<std::uint64_t> there;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!stands(pairs[i])) {
        continue;
      }
      now[{pairs[i].fiber_a, pairs[i].segment_a, pairs[i].fiber_b, pairs[i].segment_b}] = ids_[i];
      there.insert(ids_[i]);
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_TRUE(!stands(pairs[j]) || (ids_[i] == ids_[j]) == (parts[i] == parts[j]));
      }
    }
    for (const auto& [key, id] : now) {
      const auto old = before.find(key);
      if (old == before.end()) {
        continue;
      }
      ++stayed;
      // It is the same, has met an older one, or has parted from what goes on under its id.
      EXPECT_TRUE(id <= old->second || there.count(old->second) > 0) << id << " " << old->second;
    }
    std::set<std::uint64_t> ended;
    for (const TouchEvent& event : events) {
      const std::uint64_t id = event.touch.id;
      if (event.kind == TouchEvent::Kind::ENDED) {
        EXPECT_EQ(open.erase(id), 1U);
        ended.insert(id);
        EXPECT_EQ(there.count(id), 0U);
        continue;
      }
      EXPECT_TRUE(open.insert(id).second);
      TimeBounds first =
          at(std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max());
      TimeBounds joined = at(std::numeric_limits<std::int64_t>::max(), 0);
      bool has_parted = false;
      bool was_there = false;
      std::size_t count = 0;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (ids_[i] != id) {
          continue;
        }
        ++count;
        const bool was_before = pairs[i].first.upper <= step.lower;
        was_there = was_there || (was_before && stands(pairs[i]));
        if (stands(pairs[i]) || !was_before) {
          first.lower = std::min(first.lower, pairs[i].first.lower);
          first.upper = std::min(first.upper, pairs[i].first.upper);
        }
        for (std::size_t j = 0; j < pairs.size(); ++j) {
          if (whole[i] == whole[j] && pairs[j].is_gone) {
            joined = {std::min(joined.lower, pairs[j].last.lower),
                      std::max(joined.upper, pairs[j].last.upper)};
          }
          has_parted = has_parted || (whole[i] == whole[j] && ids_[j] != id);
        }
      }
      ASSERT_GT(count, 0U) << "it began, and nothing of it is there";
      parted += was_there ? 1 : 0;
      ASSERT_TRUE(!was_there || has_parted);
      EXPECT_EQ(event.time.lower, (was_there ? joined : first).lower);
      EXPECT_EQ(event.time.upper, (was_there ? joined : first).upper);
    }
    ASSERT_EQ(open, there) << "each is there from its beginning to its end";
    before = std::move(now);
  }
  expect_enough(parted, static_cast<std::size_t>(rounds(100)));
  expect_enough(stayed, static_cast<std::size_t>(rounds(5000)));
}

/// The same of closed fibres, two of which may touch themselves, and of objects.
TEST_F(TouchTrackerTest, PatchesAcrossSeamsAreThoseOfAllPairs) {
  Random random;
  constexpr std::uint32_t last = 6;
  std::size_t across = 0;  // pairs that a seam alone joins
  for (int round = 0; round < rounds(3000); ++round) {
    TouchSeams seams;
    seams.are_of_both = random.uniform(0, 1) < 0.7;
    for (int fiber = 0; fiber < 3; ++fiber) {
      seams.last_segments.push_back(random.uniform(0, 1) < 0.7 ? last : 0);
    }
    tracker_.set_seams(seams);
    std::set<std::array<std::uint32_t, 4>> drawn;
    for (std::int64_t i = random.integer(0, 25); i > 0; --i) {
      const auto fiber_a = static_cast<std::uint32_t>(random.integer(0, 1));
      const auto fiber_b = static_cast<std::uint32_t>(random.integer(1, 2));
      const auto a = static_cast<std::uint32_t>(random.integer(0, last));
      const auto b = static_cast<std::uint32_t>(random.integer(0, last));
      if (fiber_a < fiber_b || a < b) {
        drawn.insert({fiber_a, a, fiber_b, b});
      }
    }
    std::vector<TouchingPair> pairs;
    for (const auto& [fiber_a, a, fiber_b, b] : drawn) {
      pairs.push_back({fiber_a, a, fiber_b, b, -1e-3, false, step_, {}});
    }
    step_with(pairs);
    const auto all = [](const TouchingPair&) { return true; };
    const std::vector<std::size_t> patch = patches_of(pairs, all, seams);
    const std::vector<std::size_t> open_patch = patches_of(pairs, all);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_EQ(ids_[i] == ids_[j], patch[i] == patch[j]);
        across += patch[i] == patch[j] && open_patch[i] != open_patch[j] ? 1 : 0;
      }
    }
  }
  expect_enough(across, static_cast<std::size_t>(rounds(1500)));
}

/// Fibre 0 is closed, of ten segments, fibre 1 of seven.
TEST_F(TouchTrackerTest, ATouchKeepsItsIdAcrossASeam) {
  tracker_.set_seams({{9, 6}, true});
  step({{8, 3}});
  EXPECT_EQ(step({{8, 3}, {9, 3}}).size(), 0U);
  EXPECT_EQ(step({{0, 3}, {8, 3}, {9, 3}}).size(), 0U) << "one patch";
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1, 1, 1}));
  EXPECT_EQ(step({{1, 3}}).size(), 0U) << "next to one that there was";
  EXPECT_EQ(step({{0, 2}}).size(), 0U);
  EXPECT_EQ(step({{9, 1}}).size(), 0U);
  EXPECT_EQ(step({{9, 0}}).size(), 0U);
  EXPECT_EQ(step({{0, 6}}).size(), 0U) << "across both";
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1}));
  tracker_.set_seams({});
  EXPECT_EQ(step({{9, 6}}).size(), 2U) << "far from each other on open fibres";
}

TEST_F(TouchTrackerTest, ATouchOfAClosedFiberWithItselfKeepsItsIdAcrossTheSeam) {
  tracker_.set_seams({{9, 0}, true});
  const auto self = [&](std::uint32_t a, std::uint32_t b) {
    return step_with({{0, a, 0, b, -1e-3, false, step_, {}}}).size();
  };
  self(4, 9);
  EXPECT_EQ(self(0, 4), 0U);
  EXPECT_EQ(self(4, 9), 0U);
  EXPECT_EQ(self(0, 5), 0U);
  EXPECT_EQ(ids_, (std::vector<std::uint64_t>{1}));
}

TEST_F(TouchTrackerTest, ObjectsHaveNoSeam) {
  tracker_.set_seams({{9, 6}, false});
  step({{9, 6}});
  EXPECT_EQ(step({{0, 6}}).size(), 0U);
  EXPECT_EQ(step({{0, 0}}).size(), 2U);
}

}  // namespace
}  // namespace fiber::test
