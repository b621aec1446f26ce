#include "src/accuracy/setting_choices.hpp"

#include <algorithm>

#include "src/accuracy/number_text.hpp"
#include "src/accuracy/resampling.hpp"

namespace fiber {
namespace {

/// Above so many segments an engine that examines every pair is not compared.
constexpr std::size_t max_brute_force_segments = 1000;

/// Resampled fibres are compared where they have at most this part of the points.
constexpr double max_resampled_part = 0.8;

bool have_same_points(const std::vector<FiberFrame>& frames) {
  return std::all_of(frames.begin(), frames.end(), [&](const FiberFrame& frame) {
    return frame.fibers.offsets() == frames.front().fibers.offsets();
  });
}

/// Errors of chords [m] that leave out enough points to be compared.
std::vector<double> chord_errors_of(const std::vector<FiberFrame>& frames,
                                    std::vector<std::string>& left_out) {
  if (!have_same_points(frames)) {
    left_out.emplace_back("resampling: the frames have different points");
    return {};
  }
  const FiberAssembly& first = frames.front().fibers;
  std::vector<double> errors;
  for (const double error : compared_tolerances()) {
    const std::size_t points = enough_points({&first}, error).size();
    if (static_cast<double>(points) <=
        max_resampled_part * static_cast<double>(first.point_count())) {
      errors.push_back(error);
    }
  }
  if (errors.empty()) {
    left_out.emplace_back("resampling: no point is within " +
                          millimetres(compared_tolerances().back()) + " of a chord");
  }
  return errors;
}

double mean_segment_length(const FiberAssembly& fibers) {
  double sum = 0.0;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      sum += (fibers.points()[i + 1] - fibers.points()[i]).norm();
    }
  }
  return sum / static_cast<double>(fibers.segment_count());
}

/// Skins [m] beside the one that the engine chooses: none, and several times what points move. One
/// that is as long as segments has too many pairs to pay, and of hair more than memory holds.
/// @param step [m] that points move from frame to frame
std::vector<double> skins_of(const FiberAssembly& fibers, double step,
                             std::vector<std::string>& left_out) {
  std::vector<double> skins{0.0};
  const double longest = mean_segment_length(fibers);
  for (const double steps : {4.0, 16.0}) {
    const double skin = steps * step;
    if (skin > longest) {
      left_out.push_back("skin of " + millimetres(skin) + ": segments are " + millimetres(longest) +
                         " long, and points move too far in a frame");
    } else if (skin > 0.0) {
      skins.push_back(skin);
    }
  }
  if (step == 0.0) {
    left_out.emplace_back("skin: no motion from frame to frame is known");
  }
  return skins;
}

std::vector<std::string> fast_enough(const std::vector<std::string>& engines,
                                     const SettingChoices& choices, std::size_t segments,
                                     std::vector<std::string>& left_out) {
  std::vector<std::string> fast;
  for (const std::string& engine : engines) {
    if (engine == "brute_force" && segments > max_brute_force_segments) {
      left_out.push_back("engine brute_force: it examines every pair of " +
                         std::to_string(segments) + " segments");
    } else if (engine != choices.engine) {
      fast.push_back(engine);
    }
  }
  return fast;
}

/// One thread beside several, or as many as there are beside one.
std::vector<std::uint32_t> other_threads(const SettingChoices& choices) {
  const auto used = [&](std::uint32_t threads) {
    return make_engine(choices.engine, {threads})->facts().thread_count;
  };
  if (used(choices.engine_options.threads) > 1) {
    return {1};
  }
  return used(0) > 1 ? std::vector<std::uint32_t>{0} : std::vector<std::uint32_t>{};
}

}  // namespace

void choose_by_frames(const std::vector<FiberFrame>& frames, double step, SettingChoices& choices,
                      std::vector<std::string>& left_out) {
  const FiberAssembly& first = frames.front().fibers;
  choices.other_engines =
      fast_enough(choices.other_engines, choices, first.segment_count(), left_out);
  choices.threads = other_threads(choices);
  choices.skins = skins_of(first, step, left_out);
  choices.chord_errors = chord_errors_of(frames, left_out);
}

}  // namespace fiber
