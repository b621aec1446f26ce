#include "src/query/skin_choice.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace fiber {
namespace {

// [ns] What one takes on one thread (docs/performance.md says how that was measured).
constexpr double fit_ns = 12.0;    // a segment
constexpr double motion_ns = 3.0;  // a point
constexpr double test_ns = 8.0;    // a node's children
constexpr double find_ns = 30.0;   // a pair that a search comes upon, its sorting included
constexpr double judge_ns = 80.0;  // a pair

constexpr double first_frames = 4.0;  // that the first skin lasts for
constexpr double least_frames = 2.0;
constexpr double most_frames = 4096.0;
constexpr double least_skin = 1e-150;        // [m]
constexpr std::uint32_t longest_wait = 256;  // [frames]

// A skin must save this part of a frame, as costs are estimates.
constexpr double least_gain = 0.05;

// Pairs beyond those that there are without a skin grow with this power of it: between those along
// lines that cross (1) and those within a volume (2).
constexpr double growth = 1.5;

// The part of the segments by whose motion the skin goes. The others may be looked for anew alone
// (RunTreeEngine::most_still_serve).
constexpr double followed_part = 0.75;
constexpr std::size_t most_sampled = 1024;  // fibres

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
  if (is_automatic_) {
    do_without();
    wait_ = 1;
    next_wait_ = 2;
  }
  pays_ = skin_ > 0.0;
  frames_ = 0;
  stretch_ = {};
  take_work();
}

void SkinChoice::end_frame() {
  const Work frame = take_work();
  stretch_.search += frame.search;
  stretch_.found += frame.found;
  stretch_.judged += frame.judged;
  stretch_.motion += frame.motion;
  ++frames_;
}

void SkinChoice::begin_stretch(const FiberAssembly& fibers, const std::vector<double>* moved) {
  if (!is_automatic_) {
    pays_ = skin_ > 0.0 && frames_ > 1;
  } else if (moved == nullptr) {
    without_ = stretch_;
    wait_ -= std::min(wait_, 1U);
  } else {
    if (meant_frames_ == 0.0) {
      without_ = stretch_;
      stretch_.motion = motion_ns * static_cast<double>(fibers.point_count());
    }
    const double frames = are_too_many_ ? 0.0 : best_frames();
    if (frames > 0.0) {
      take(frames, motion_of_most(fibers, *moved) / frames_);
    } else {
      do_without();
    }
  }
  frames_ = 0;
  stretch_ = {};
  are_too_many_ = false;
}

SkinChoice::Work SkinChoice::take_work() {
  const auto take = [](std::atomic<std::uint64_t>& count, double ns) {
    return ns * static_cast<double>(count.exchange(0));
  };
  Work work;
  work.search = take(fitted_, fit_ns) + take(node_tests_, test_ns);
  work.found = take(found_, find_ns);
  work.judged = take(judged_, judge_ns);
  work.motion = take(measured_, motion_ns);
  return work;
}

/// [ns] a frame, of a skin that is meant to last for so many, as the last stretch was.
double SkinChoice::cost_with(double frames) const {
  double more_pairs = 1.0;  // than in the last stretch
  double lasts = frames;
  if (meant_frames_ > 0.0) {
    const double now = stretch_.judged / frames_;
    const double beyond = std::max(0.0, now - without_.judged);
    if (now > 0.0) {
      more_pairs += beyond * (std::pow(frames / meant_frames_, growth) - 1.0) / now;
    }
    // Points may not go on as they began.
    lasts = std::max(1.0, frames * std::min(4.0, frames_ / meant_frames_));
  }
  return (stretch_.search + stretch_.found * more_pairs) / lasts +
         (stretch_.motion + stretch_.judged * more_pairs) / frames_;
}

/// For how many frames the next skin is to last; 0: none pays.
double SkinChoice::best_frames() const {
  const double affordable = (1.0 - least_gain) * without_.sum();
  if (meant_frames_ == 0.0) {
    return cost_with(first_frames) < affordable ? first_frames : 0.0;
  }
  // What this stretch has cost beyond what was expected, the next one costs, too.
  const double unexpected = std::max(1.0, stretch_.sum() / frames_ / cost_with(meant_frames_));
  double best = 0.0;
  double least = affordable / unexpected;
  for (const double factor : {0.5, 0.71, 1.0, 1.41, 2.0}) {
    const double frames = std::clamp(factor * meant_frames_, least_frames, most_frames);
    const double cost = cost_with(frames);
    if (cost < least) {
      least = cost;
      best = frames;
    }
  }
  return best;
}

/// [m] How far those segments have moved that the skin is for: by some fibres, spread over all.
double SkinChoice::motion_of_most(const FiberAssembly& fibers, const std::vector<double>& moved) {
  const auto point_count = [&](std::size_t fiber) {
    return fibers.offsets()[fiber + 1] - fibers.offsets()[fiber];
  };
  sample_.clear();
  double left = 0.0;
  const std::size_t step = 1 + fibers.fiber_count() / most_sampled;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); fiber += step) {
    sample_.emplace_back(moved[fiber], point_count(fiber));
    left += followed_part * point_count(fiber);
  }
  std::sort(sample_.begin(), sample_.end());
  double motion = 0.0;
  for (auto next = sample_.begin(); next != sample_.end() && left > 0.0; ++next) {
    motion = next->first;
    left -= next->second;
  }
  return motion;
}

/// @param motion [m] a frame
void SkinChoice::take(double frames, double motion) {
  meant_frames_ = frames;
  // Two points may come towards each other. Those that stand still are measured by more than
  // nothing.
  skin_ = std::max(least_skin, 2.0 * frames * motion);
  most_pairs_ = static_cast<std::uint64_t>(without_.sum() / judge_ns);
  pays_ = true;
  if (frames_ > 1) {
    next_wait_ = 1;
  }
}

void SkinChoice::do_without() {
  meant_frames_ = 0.0;
  skin_ = 0.0;
  pays_ = false;
  wait_ = next_wait_;
  next_wait_ = std::min(longest_wait, 2 * next_wait_);
}

}  // namespace fiber
