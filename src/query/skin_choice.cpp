#include "src/query/skin_choice.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace fiber {
namespace {

// [ns] What one takes on one thread: least squares over `fiber_bench coherence --json` on eight
// scenes with five skins, which they explain to 14 % (AMD EPYC, 2026-11-29). Tests of boxes that
// are not near, which those of the others come with, had nothing to explain.
constexpr double fit_ns = 24.0;      // a segment
constexpr double motion_ns = 12.0;   // a point
constexpr double begin_ns = 14.0;    // a point, to note where it is and that it has moved too far
constexpr double overlap_ns = 63.0;  // a box that is near, with all that is done about it
constexpr double find_ns = 163.0;    // a pair that a search comes upon, its sorting included
constexpr double judge_ns = 41.0;    // a pair

constexpr double first_frames = 4.0;  // that the first skin thought of lasts for
constexpr double min_frames = 3.0;    // one that serves a single frame more has too little to win
constexpr double max_frames = 4096.0;
constexpr double reserve = 1.05;             // by which points may move more than they did
constexpr double step = 1.5;                 // from one skin that is thought of to the next
constexpr double min_skin = 1e-150;          // [m]
constexpr std::uint32_t longest_wait = 256;  // [frames]
constexpr std::uint32_t longest_kept = 8;    // [stretches]

// A skin must save this part of a frame, as costs are estimates.
constexpr double min_gain = 0.05;

// The part of the segments by whose motion the skin goes. The others may be looked for anew alone
// (RunTreeEngine::most_still_serve).
constexpr double followed_part = 0.75;
constexpr std::size_t max_sampled = 1024;  // fibres

double checked(const std::optional<double>& skin) {
  if (skin && !(*skin >= 0.0 && std::isfinite(*skin))) {
    throw std::invalid_argument("skin is " + std::to_string(*skin) +
                                " m, it must be finite and not negative");
  }
  return skin.value_or(0.0);
}

}  // namespace

SkinChoice::SkinChoice(const std::optional<double>& fixed)
    : is_automatic_(!fixed), skin_(checked(fixed)), pays_(skin_ > 0.0) {}

void SkinChoice::start() {
  frames_ = 0;
  if (is_automatic_) {
    sample_.reserve(max_sampled + 1);
    do_without();
    wait_ = 1;
    next_wait_ = 2;
    motion_too_fast_ = std::numeric_limits<double>::infinity();
    last_frames_ = first_frames;
    lasted_ = 1.0;
  }
  pays_ = skin_ > 0.0;
  are_too_many_ = false;
}

void SkinChoice::begin_stretch(const FiberAssembly& fibers, const MotionBound* motion) {
  if (!is_automatic_) {
    pays_ = skin_ > 0.0 && frames_ > 1;
  } else if (is_due_ || are_too_many_) {
    do_without();  // nobody has asked for what could be kept, or it could not be
  } else if (motion == nullptr) {
    wait_ -= std::min(wait_, 1U);
  } else {
    motion_ = motion->beside_others();
    if (motion->by_fiber() != nullptr) {
      motion_ = std::min(motion_, motion_of_most(fibers, *motion->by_fiber()));
    }
    motion_ /= frames_;
    const bool had_one = frames_meant_ > 0.0;
    if (had_one) {
      const double before = lasted_;
      // A frame less is what rounding may cost.
      const double with_one_more = std::min(1.0, (frames_ + 1) / frames_meant_);
      lasted_ = std::min(4.0, std::max(frames_ / frames_meant_, with_one_more));
      next_wait_ = 1;
      const bool is_as_before = lasted_ < step * before && before < step * lasted_;
      kept_for_ = is_as_before ? kept_for_ : 0;
    }
    if (kept_for_ > 0) {
      --kept_for_;
      last_for(last_frames_);
    } else if (!had_one && step * motion_ > motion_too_fast_) {
      do_without();
    } else {
      frames_meant_ = 0.0;
      skin_ = 0.0;
      pays_ = false;
      is_due_ = true;
    }
  }
  are_too_many_ = false;
  frames_ = 0;
}

void SkinChoice::decide(const FiberAssembly& fibers, const Estimate& estimate) {
  const std::lock_guard lock(mutex_);
  if (!is_due_) {
    return;
  }
  is_due_ = false;
  // While its estimates wait for other threads, this one must not begin with another query: that
  // would ask for a choice as well, and wait for itself.
  tbb::this_task_arena::isolate([&] { choose(fibers, estimate); });
}

void SkinChoice::choose(const FiberAssembly& fibers, const Estimate& estimate) {
  double best = 0.0;
  double taken = 0.0;  // [ns] by this
  const auto size_of = [&](double skin, double max_pairs) {
    const SearchSize search = estimate(skin, max_pairs);
    taken += search.part * (overlap_ns * search.overlaps + find_ns * search.pairs);
    return search;
  };
  const double without = cost(0.0, fibers, size_of(0.0, std::numeric_limits<double>::infinity()));
  double least = (1.0 - min_gain) * without;
  const auto is_better = [&](double frames) {
    // A skin of more pairs costs more, whatever else there is.
    const double of_none = cost(frames, fibers, {});
    const double of_one = cost(frames, fibers, {0.0, 1.0, 0.0}) - of_none;
    if (of_none >= least) {
      return false;
    }
    const SearchSize search = size_of(skin_of(frames), (least - of_none) / of_one);
    const double now = cost(frames, fibers, search);
    if (now >= least) {
      return false;
    }
    least = now;
    best = frames;
    max_pairs_ = static_cast<std::uint64_t>(4.0 * search.pairs) + (1U << 16U);
    return true;
  };
  // Up from the last one while that is better; or else down, until it is worse again.
  const double begin = last_frames_;
  double frames = begin;
  while (frames <= max_frames && is_better(frames)) {
    frames = std::round(frames * step);
  }
  frames = std::round(begin / step);
  while (best <= begin && frames >= min_frames && (is_better(frames) || best == 0.0)) {
    frames = std::round(frames / step);
  }
  // Where there is little to search, a choice takes as much as some searches do.
  if (best == 0.0 || (without - least) * best * longest_kept < taken) {
    motion_too_fast_ = motion_;
    do_without();
    return;
  }
  kept_for_ = next_kept_for_;
  next_kept_for_ = std::min(longest_kept, 2 * next_kept_for_);
  last_for(best);
}

/// [m] The tree is fitted in the first of the frames. Two points may come towards each other. Those
/// that stand still are measured by more than nothing.
double SkinChoice::skin_of(double frames) const {
  return std::max(min_skin, 2.0 * reserve * (frames - 1.0) * motion_);
}

/// Takes the skin that is meant to last for so many frames.
void SkinChoice::last_for(double frames) {
  frames_meant_ = frames;
  last_frames_ = frames;
  skin_ = skin_of(frames);
  pays_ = true;
}

/// [ns] a frame, of a skin that is meant to last for so many; 0: without one.
double SkinChoice::cost(double frames, const FiberAssembly& fibers,
                        const SearchSize& search) const {
  const double find = fit_ns * static_cast<double>(fibers.segment_count()) +
                      overlap_ns * search.overlaps + find_ns * search.pairs;
  const double judge = judge_ns * search.pairs;
  if (frames == 0.0) {
    return find + judge;
  }
  const auto points = static_cast<double>(fibers.point_count());
  // Points may not go on as they began.
  return (find + begin_ns * points) / std::max(1.0, frames * lasted_) + motion_ns * points + judge;
}

/// [m] How far those segments have moved that the skin is for: by some fibres, spread over all.
double SkinChoice::motion_of_most(const FiberAssembly& fibers, const std::vector<double>& moved) {
  sample_.clear();
  double left = 0.0;  // points
  const std::size_t stride = 1 + fibers.fiber_count() / max_sampled;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); fiber += stride) {
    const std::uint32_t points = fibers.offsets()[fiber + 1] - fibers.offsets()[fiber];
    sample_.emplace_back(moved[fiber], points);
    left += followed_part * points;
  }
  std::sort(sample_.begin(), sample_.end());
  double motion = 0.0;
  for (auto next = sample_.begin(); next != sample_.end() && left > 0.0; ++next) {
    motion = next->first;
    left -= next->second;
  }
  return motion;
}

void SkinChoice::do_without() {
  is_due_ = false;
  frames_meant_ = 0.0;
  skin_ = 0.0;
  pays_ = false;
  kept_for_ = 0;
  next_kept_for_ = 1;
  wait_ = next_wait_;
  if (wait_ == longest_wait) {  // what else there is may have changed by then
    motion_too_fast_ = std::numeric_limits<double>::infinity();
  }
  next_wait_ = std::min(longest_wait, 2 * next_wait_);
}

}  // namespace fiber
