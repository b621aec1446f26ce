#include "src/query/touch_tracker.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "src/query/touch_runs.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr TimeBounds never{std::chrono::nanoseconds::max(), std::chrono::nanoseconds::max()};

/// Joins runs that are neighbours.
/// @param roots  becomes by run the first that it is joined with
/// @param firsts by pair of the runs: becomes the first pair that it is joined with
void join_runs(const std::vector<TouchRun>& runs, const TouchSeams& seams, DisjointSets& joined,
               std::vector<std::uint32_t>& roots, std::vector<std::uint32_t>& firsts) {
  joined.reset(static_cast<std::uint32_t>(runs.size()));
  NearTouchRuns near(runs, seams);
  for (std::uint32_t i = 0; i < runs.size(); ++i) {
    near.for_each(runs[i], i, [&](std::size_t neighbour) {
      joined.join(static_cast<std::uint32_t>(neighbour), i);
    });
  }
  joined.find_roots(roots);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::fill(firsts.begin() + runs[i].begin, firsts.begin() + runs[i].end, runs[roots[i]].begin);
  }
}

TimeBounds earlier(const TimeBounds& x, const TimeBounds& y) {
  return {std::min(x.lower, y.lower), std::min(x.upper, y.upper)};
}

TimeBounds later(const TimeBounds& x, const TimeBounds& y) {
  return {std::max(x.lower, y.lower), std::max(x.upper, y.upper)};
}

}  // namespace

void TouchTracker::advance(const std::vector<TouchingPair>& pairs, const TimeBounds& step,
                           std::vector<TouchEvent>& events) {
  find_patches(pairs);
  find_claims(pairs);
  std::swap(touches_, last_touches_);
  touches_.clear();
  go_on();
  begin_others(pairs.size());
  standing_.clear();
  touch_of_pair_.resize(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const TouchingPair& pair = pairs[i];
    const std::uint32_t touch = touch_of_patch_[patches_[i]];
    touch_of_pair_[i] = touch;
    take(pair, step, touches_[touch]);
    if (!pair.is_gone) {
      standing_.push_back({static_cast<const SegmentIdPair&>(pair), touch});
    }
  }
  begin_when_parted(pairs.size());
  for (TouchStep& touch : touches_) {
    if (touch.is_new) {
      if (touch.touch.began.lower == never.lower) {  // nobody has told of it before
        touch.touch.began = touch.left;
      }
      assert(touch.touch.began.upper < never.upper);
      events.push_back({TouchEvent::Kind::BEGAN, touch.touch, touch.touch.began});
    }
  }
  end_unclaimed(step, events);
  for (const TouchStep& touch : touches_) {
    if (!touch.lasts) {
      events.push_back({TouchEvent::Kind::ENDED, touch.touch, touch.last});
    }
  }
}

/// patches_ is the first pair of each pair's patch; of a patch that has parted, of its part.
void TouchTracker::find_patches(const std::vector<TouchingPair>& pairs) {
  const auto is_gone = [&pairs](std::size_t i) -> std::uint64_t {
    return pairs[i].is_gone ? 1 : 0;
  };
  find_touch_runs(pairs, is_gone, runs_);
  patches_.resize(pairs.size());
  join_runs(runs_, seams_, joined_, roots_, patches_);
  partings_.clear();
  if (find_parts(pairs)) {
    share_gone_pairs(pairs);
    find_touch_runs(
        pairs, [&](std::size_t i) { return 2 * std::uint64_t{patches_[i]} + is_gone(i); }, runs_);
  }
}

/// Finds what is left of each patch at the end of the step.
/// @returns whether one has parted
bool TouchTracker::find_parts(const std::vector<TouchingPair>& pairs) {
  const auto is_gone = [](const TouchingPair& pair) { return pair.is_gone; };
  if (std::none_of(pairs.begin(), pairs.end(), is_gone)) {
    return false;
  }
  find_touch_runs(
      pairs, [&pairs](std::size_t i) { return pairs[i].is_gone ? no_kind : 0; }, other_runs_);
  parts_.assign(pairs.size(), none);
  join_runs(other_runs_, seams_, joined_, roots_, parts_);
  bool one_has_parted = false;
  partings_.assign(pairs.size(), {none, false, {std::chrono::nanoseconds::max(), {}}});
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    Parting& parting = partings_[patches_[i]];
    if (pairs[i].is_gone) {  // it may have been what joined them
      parting.time = {std::min(parting.time.lower, pairs[i].last.lower),
                      std::max(parting.time.upper, pairs[i].last.upper)};
    } else if (parting.first_part == none) {
      parting.first_part = parts_[i];
    } else if (parting.first_part != parts_[i]) {
      parting.has_parted = one_has_parted = true;
    }
  }
  return one_has_parted;
}

/// Makes the parts of patches that have parted patches of their own. A pair that is gone goes with
/// the part that the fewest pairs are between, of several the first.
void TouchTracker::share_gone_pairs(const std::vector<TouchingPair>& pairs) {
  // Each pair alone.
  find_touch_runs(
      pairs, [](std::size_t i) -> std::uint64_t { return i; }, other_runs_);
  std::vector<std::uint32_t> unshared;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    if (partings_[patches_[i]].has_parted && pairs[i].is_gone) {
      unshared.push_back(i);
    }
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;
  do {
    shared.clear();
    NearTouchRuns near(other_runs_, seams_);
    for (const std::uint32_t i : unshared) {
      std::uint32_t part = none;
      near.for_each(other_runs_[i], pairs.size(),
                    [&](std::size_t neighbour) { part = std::min(part, parts_[neighbour]); });
      if (part != none) {
        shared.emplace_back(i, part);
      }
    }
    for (const auto& [pair, part] : shared) {
      parts_[pair] = part;
    }
    unshared.erase(std::remove_if(unshared.begin(), unshared.end(),
                                  [this](std::uint32_t i) { return parts_[i] != none; }),
                   unshared.end());
  } while (!shared.empty());
  assert(unshared.empty());  // each is of a patch that has a part
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Parting parting = partings_[patches_[i]];
    if (parting.has_parted) {
      patches_[i] = parts_[i];
      partings_[parts_[i]] = parting;
    }
  }
}

void TouchTracker::find_claims(const std::vector<TouchingPair>& pairs) {
  claims_.clear();
  claimed_last_.assign(2 * touches_.size(), none);
  find_touch_runs(
      standing_, [this](std::size_t i) -> std::uint64_t { return standing_[i].touch; },
      other_runs_);
  NearTouchRuns before(other_runs_, seams_);
  for (const TouchRun& run : runs_) {
    const std::uint32_t patch = patches_[run.begin];
    before.for_each(run, other_runs_.size(), [&](std::size_t neighbour) {
      const TouchRun& stood = other_runs_[neighbour];
      const bool stays = !pairs[run.begin].is_gone && stood.a == run.a &&
                         stood.first_b <= run.last_b && run.first_b <= stood.last_b;
      const auto touch = static_cast<std::uint32_t>(stood.kind);
      std::uint32_t& last = claimed_last_[2 * touch + (stays ? 0 : 1)];
      if (std::exchange(last, patch) != patch) {
        claims_.push_back({touch, !stays, patch});
      }
    });
  }
  std::sort(claims_.begin(), claims_.end(), by_key);
}

/// Touches go on, the oldest first, in the first patch that is left for them.
void TouchTracker::go_on() {
  touch_of_patch_.assign(patches_.size(), none);
  for (const Claim& claim : claims_) {
    TouchStep& before = last_touches_[claim.touch];
    if (before.lasts && touch_of_patch_[claim.patch] == none) {
      touch_of_patch_[claim.patch] = static_cast<std::uint32_t>(touches_.size());
      touches_.push_back({before.touch, false, false, {}, false, never});
      touches_.back().touch.pair.distance = std::numeric_limits<double>::infinity();
      before.lasts = false;  // as that one
    }
  }
}

/// Touches of patches that none goes on in.
void TouchTracker::begin_others(std::size_t pair_count) {
  for (std::size_t i = 0; i < pair_count; ++i) {
    if (patches_[i] == i && touch_of_patch_[i] == none) {
      touch_of_patch_[i] = static_cast<std::uint32_t>(touches_.size());
      TouchStep touch{{}, true, false, {}, false, never};
      touch.touch.id = next_id_;
      touch.touch.began = never;
      touch.touch.deepest = std::numeric_limits<double>::infinity();
      touch.touch.pair.distance = touch.touch.deepest;
      next_id_ += id_step_;
      touches_.push_back(touch);
    }
  }
}

void TouchTracker::take(const TouchingPair& pair, const TimeBounds& step, TouchStep& taken) {
  Touch& touch = taken.touch;
  touch.deepest = std::min(touch.deepest, pair.distance);
  if (pair.distance < touch.pair.distance) {
    touch.pair = pair;
  }
  const bool was_there = pair.first.upper <= step.lower;
  TimeBounds& began = was_there && pair.is_gone ? taken.left : touch.began;
  if (taken.is_new) {
    began = earlier(began, pair.first);
  }
  if (pair.is_gone) {
    taken.last = later(taken.last, pair.last);
  }
  taken.lasts = taken.lasts || !pair.is_gone;
  taken.was_there = taken.was_there || (was_there && !pair.is_gone);
}

/// A patch that was there already and has parted from a touch that goes on elsewhere begins when it
/// parts.
void TouchTracker::begin_when_parted(std::size_t pair_count) {
  for (std::size_t i = 0; i < pair_count && !partings_.empty(); ++i) {
    TouchStep& touch = touches_[touch_of_patch_[patches_[i]]];
    if (partings_[patches_[i]].has_parted && touch.is_new && touch.was_there) {
      touch.touch.began = partings_[patches_[i]].time;
    }
  }
}

/// Those that have found no patch have ended, if they had not before.
void TouchTracker::end_unclaimed(const TimeBounds& step, std::vector<TouchEvent>& events) {
  for (const TouchStep& touch : last_touches_) {
    if (touch.lasts) {
      events.push_back({TouchEvent::Kind::ENDED, touch.touch, step});
    }
  }
}

void TouchTracker::renumber(const FiberIndices& indices, const TimeBounds& step,
                            std::vector<TouchEvent>& events) {
  renumber(indices, indices, step, events);
  for (Standing& pair : standing_) {
    if (std::tie(pair.fiber_b, pair.segment_b) < std::tie(pair.fiber_a, pair.segment_a)) {
      std::swap(pair.fiber_a, pair.fiber_b);
      std::swap(pair.segment_a, pair.segment_b);
    }
  }
  std::sort(standing_.begin(), standing_.end(), by_key);
}

void TouchTracker::renumber(const FiberIndices& indices_a, const FiberIndices& indices_b,
                            const TimeBounds& step, std::vector<TouchEvent>& events) {
  std::vector<bool> stays(touches_.size());
  std::vector<Standing> standing;
  for (Standing pair : standing_) {
    const std::optional<std::uint32_t> a = indices_a[pair.fiber_a];
    const std::optional<std::uint32_t> b = indices_b[pair.fiber_b];
    if (a && b) {
      pair.fiber_a = *a;
      pair.fiber_b = *b;
      standing.push_back(pair);
      stays[pair.touch] = true;
    }
  }
  standing_ = std::move(standing);
  std::sort(standing_.begin(), standing_.end(), by_key);
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    if (touches_[i].lasts && !stays[i]) {
      events.push_back({TouchEvent::Kind::ENDED, touches_[i].touch, step});
      touches_[i].lasts = false;
    }
  }
}

void TouchTracker::forget() {
  touches_.clear();
  standing_.clear();
  touch_of_pair_.clear();
}

}  // namespace fiber
