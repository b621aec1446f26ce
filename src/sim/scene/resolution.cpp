#include "src/sim/scene/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/sim/resolution.hpp"
#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/parts.hpp"

namespace fiber {
namespace {

double read_accuracy(const YamlField& field) {
  constexpr const char* allowed = "above 0 and at most 0.5, or 50 %";
  std::string text = field.text();
  const bool is_percent = !text.empty() && text.back() == '%';
  if (is_percent) {
    text.pop_back();
  }
  std::size_t used = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    field.refuse(allowed);
  }
  used = std::min(text.size(), text.find_first_not_of(' ', used));
  value *= is_percent ? 0.01 : 1.0;
  if (used != text.size() || !(value > 0.0 && value <= 0.5)) {
    field.refuse(allowed);
  }
  return value;
}

}  // namespace

SceneResolution::SceneResolution(const YamlField& document, double gravity,
                                 const std::vector<JointEntry>& joints)
    : document_(document), gravity_(gravity) {
  const auto accuracy = document.find("accuracy");
  const auto real_time = document.find("real_time");
  is_real_time_ = real_time && real_time->flag();
  if (accuracy && is_real_time_) {
    real_time->refuse("absent or false where there is an accuracy");
  }
  if (const auto given = document.find("substeps")) {
    given_substeps_ = static_cast<std::uint32_t>(given->integer(1, max_substeps));
  }
  fibers_ = read_fibers(document.get("fibers"), accuracy || is_real_time_);
  for (FiberEntry& fiber : fibers_) {
    fiber.joint_shares = joint_shares(joints, fiber);
    fiber.limpness = fiber.length > 0.0 ? limpness(fiber.section, fiber.length, gravity) : 0.0;
  }
  if (accuracy) {
    accuracy_ = read_accuracy(*accuracy);
  }
}

/// The substeps given, or chosen for an accuracy by the fibre that swings fastest; with contacts,
/// at least as many as the thinnest fibre needs.
std::uint32_t SceneResolution::substeps_for(const SimDescription& scene, double accuracy) const {
  if (given_substeps_) {
    return *given_substeps_;
  }
  double period = std::numeric_limits<double>::infinity();
  double longest = scene.time_step;  // of steps [s]
  for (const FiberEntry& fiber : fibers_) {
    if (fiber.length > 0.0) {  // or it is refused when it is cut
      period = std::min(period, swing_period(fiber.section, fiber.length, gravity_));
    }
    if (scene.has_contacts) {
      double thinnest = fiber.radius;
      for (const SectionEntry& section : fiber.sections) {
        thinnest = std::min(thinnest, section.radius.value_or(thinnest));
      }
      longest = std::min(longest, max_contact_step(thinnest, gravity_));
    }
  }
  const double for_contacts = std::ceil(scene.time_step / longest);
  return std::max(static_cast<std::uint32_t>(std::min(for_contacts, 1.0 + max_substeps)),
                  fiber::substeps_for(accuracy, scene.options.integrator, scene.time_step, period));
}

SimDescription SceneResolution::cut(const SimDescription& scene,
                                    const std::optional<Resolution>& resolution) const {
  SimDescription cut = scene;
  if (resolution) {
    cut.accuracy = resolution->substeps;
    cut.substeps = substeps_for(scene, resolution->substeps);
  } else if (given_substeps_) {
    cut.substeps = *given_substeps_;
  }
  cut_fibers(fibers_, resolution ? std::optional<double>(resolution->segments) : std::nullopt, cut);
  return cut;
}

SimDescription SceneResolution::apply(const SimDescription& scene,
                                      const std::function<void(SimDescription&)>& complete,
                                      const FrameTimer& timer) const {
  if (is_real_time_) {
    return for_real_time(scene, complete, timer);
  }
  SimDescription made =
      cut(scene, accuracy_ ? std::optional<Resolution>({*accuracy_, *accuracy_}) : std::nullopt);
  if (made.substeps > max_substeps) {
    document_.get("accuracy")
        .refuse("coarser: it takes " + std::to_string(made.substeps) + " substeps a frame, " +
                std::to_string(max_substeps) +
                " are the most; bdf2 takes fewer, and `substeps` in the scene "
                "are not chosen");
  }
  complete(made);
  return made;
}

SimDescription SceneResolution::for_real_time(const SimDescription& scene,
                                              const std::function<void(SimDescription&)>& complete,
                                              const FrameTimer& timer) const {
  const auto make = [&](const Resolution& resolution) {
    SimDescription made = cut(scene, resolution);
    made.substeps = std::min(made.substeps, max_substeps);
    complete(made);
    return made;
  };
  RealTimeScene measured;
  measured.work = [&](const Resolution& resolution) {
    constexpr double max_nodes = 1e6;
    double nodes = 0.0;
    for (const FiberEntry& fiber : fibers_) {
      nodes += static_cast<double>((fiber.segments_for(resolution.segments) + 1) *
                                   fiber.count.value_or(1));
    }
    const std::uint32_t substeps = substeps_for(scene, resolution.substeps);
    return nodes > max_nodes || substeps > max_substeps ? std::numeric_limits<double>::infinity()
                                                        : nodes * substeps;
  };
  measured.frame_times = [&](const Resolution& resolution, double budget) {
    const SimDescription made = make(resolution);
    return timer ? timer(made, budget) : measure_frames(made, budget);
  };
  measured.time_step = scene.time_step;
  const RealTimeChoice choice = choose_for_real_time(measured);
  SimDescription made = make(choice.resolution);
  constexpr double max_share = 0.6;
  const bool is_slow = choice.share > max_share;
  (is_slow ? made.real_time_warning : made.real_time_note) = describe(made, choice);
  return made;
}

std::string SceneResolution::describe(const SimDescription& scene,
                                      const RealTimeChoice& choice) const {
  constexpr std::size_t max_named = 5;
  std::string segments;
  for (std::size_t i = 0; i < std::min(max_named, fibers_.size()); ++i) {
    segments += format(i == 0 ? "" : ", ", fibers_[i].segments_for(choice.resolution.segments),
                       " segments of fibre ", quote(fibers_[i].name));
  }
  const std::string more =
      fibers_.size() > max_named ? format(" and ", fibers_.size() - max_named, " more") : "";
  const bool is_slow = choice.share > 1.0;
  return format("real_time: the scene ", is_slow ? "cannot be had in real time; it " : "",
                choice.is_extrapolated ? "is expected, by what there was time to measure, to take "
                                       : "takes ",
                choice.share, " of the time there is on one core, with ", scene.substeps,
                " substeps, ", segments, more, " (accuracy ", 100.0 * choice.resolution.substeps,
                " % of substeps, ", 100.0 * choice.resolution.segments, " % of segments)");
}

}  // namespace fiber
